"""Recent history of a live duel, for plots, traces and footsteps."""

from collections import deque
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from ...games.approach_forecast import CourseApproach, estimate_approach
from ...games.duel_circle import angle_between
from ...games.match import Match
from ...games.outcome import Outcome
from ...locomotion.walk_snapshots import StepStarted

if TYPE_CHECKING:
    from ...perception.percept_stages import FrameReport

PERIOD = 0.1  # between samples, in [s]
MAX_SAMPLES = 6000  # of the plots
MAX_OFFSETS = 100  # samples of the offset
MAX_TRACE = 1500  # points of a trace
MAX_STEPS = 100  # of each player


class PlotHistory:
    """Observer of a game that keeps its recent history.

    Attributes:
        history: (time [s], distance [m], angle [deg]) of the last minutes.
        offsets: (time [s], x [m], y [m]) from the evader to the pursuer, in
            the world, of the last gait cycles.
        traces: Recent positions of CoM and ZMP in the world, in [m], by
            ``player/CoM`` and ``player/ZMP``.
        steps: Last steps of each player, by name.
        frames: Newest image of each camera with its detections, by player
            and camera.
    """

    def __init__(self) -> None:
        """Start with an empty history."""
        self.history: deque[tuple[float, float, float]] = deque(
            maxlen=MAX_SAMPLES
        )
        self.offsets: deque[tuple[float, float, float]] = deque(
            maxlen=MAX_OFFSETS
        )
        self.traces: dict[str, deque[tuple[float, float]]] = {}
        self.steps: dict[str, deque[StepStarted]] = {}
        self.frames: dict[str, FrameReport] = {}

    def before(self, match: Match) -> None:
        """Record a sample when one is due."""
        every = max(1, round(PERIOD / match.world.physics.tick))
        if match.world.ticks == 0 or match.world.ticks % every:
            return
        snapshots = [player.snapshot() for player in match.players]
        if match.distance is not None:
            pursuer, evader = (np.array([s.place]) for s in snapshots[:2])
            angle = degrees(float(angle_between(pursuer, evader)[0]))
            self.history.append((match.world.time, match.distance, angle))
            x, y = (pursuer - evader)[0, :2].tolist()
            self.offsets.append((match.world.time, x, y))
        for snapshot in snapshots:
            self._trace(f"{snapshot.name}/CoM", snapshot.com[:2])
            # The ZMP is NaN while no foot is in contact.
            if snapshot.zmp is not None and np.isfinite(snapshot.zmp[0]):
                self._trace(f"{snapshot.name}/ZMP", snapshot.zmp)

    def acted(self, match: Match) -> None:
        """Store the steps that begin, and the images that arrived."""
        for player in match.players:
            if player.begun is not None:
                steps = self.steps.setdefault(
                    player.name, deque(maxlen=MAX_STEPS)
                )
                steps.append(player.begun)
            for report in player.reports:
                camera = type(report.image).__name__.removesuffix("Image")
                self.frames[f"{player.name}, {camera.lower()}"] = report

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Do nothing."""

    def approach(self, cycle: float) -> CourseApproach | None:
        """Return the approach of the pursuer over the last gait cycle.

        Args:
            cycle: Duration of a gait cycle, in [s].

        Returns:
            The approach; None before the first cycle has passed.
        """
        if not self.offsets:
            return None
        now, x, y = self.offsets[-1]
        for time, was_x, was_y in reversed(self.offsets):
            if now - time > cycle - 0.5 * PERIOD:
                return estimate_approach((was_x, was_y), (x, y), now - time)
        return None

    def _trace(self, name: str, position: tuple[float, float]) -> None:
        trace = self.traces.setdefault(name, deque(maxlen=MAX_TRACE))
        trace.append(position)
