"""What a live page keeps of the time that has passed."""

from collections import deque
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from ...control.walk_snapshots import StepStarted
from ...games.approach_forecast import CourseApproach, approach_between
from ...games.duel_circle import angle_between
from ...games.match import Match
from ...games.outcome import Outcome

if TYPE_CHECKING:
    from ...perception.frame_report import FrameReport

PERIOD = 0.1  # between samples, in [s]
HISTORY = 6000  # samples of the plots that are kept
OFFSETS = 100  # samples of the offset that are kept
TRACE = 1500  # points of a trace that are kept
KEPT = 100  # footsteps of each player that are kept


class PlotHistory:
    """Looks on while a game is played, and forgets what is long past.

    Attributes:
        history: (time [s], distance [m], angle [deg]) of the last minutes.
        offsets: (time [s], x [m], y [m]) from the evader to the pursuer, in
            the world, of the last gait cycles.
        traces: Last places of CoM and ZMP in the world, in [m], by
            ``player/CoM`` and ``player/ZMP``.
        steps: Last steps of each player, by name.
        frames: Newest image of each camera with what was found in it, by
            player and camera; emptied by who shows them.
    """

    def __init__(self) -> None:
        """Begin with nothing."""
        self.history: deque[tuple[float, float, float]] = deque(maxlen=HISTORY)
        self.offsets: deque[tuple[float, float, float]] = deque(maxlen=OFFSETS)
        self.traces: dict[str, deque[tuple[float, float]]] = {}
        self.steps: dict[str, deque[StepStarted]] = {}
        self.frames: dict[str, FrameReport] = {}

    def before(self, match: Match) -> None:
        """Take a sample when one is due."""
        every = max(1, round(PERIOD / match.world.physics.tick))
        if match.world.ticks == 0 or match.world.ticks % every:
            return
        seen = [player.snapshot() for player in match.players]
        if match.distance is not None:
            first, second = (np.array([s.place]) for s in seen[:2])
            apart = degrees(float(angle_between(first, second)[0]))
            self.history.append((match.world.time, match.distance, apart))
            x, y = (first - second)[0, :2].tolist()
            self.offsets.append((match.world.time, x, y))
        for each in seen:
            self._trace(f"{each.name}/CoM", each.com[:2])
            if each.zmp is not None and np.isfinite(each.zmp[0]):
                self._trace(f"{each.name}/ZMP", each.zmp)

    def acted(self, match: Match) -> None:
        """Keep the steps that begin, and the images that arrived."""
        for player in match.players:
            if player.begun is not None:
                steps = self.steps.setdefault(player.name, deque(maxlen=KEPT))
                steps.append(player.begun)
            for report in player.reports:
                camera = type(report.image).__name__.removesuffix("Image")
                self.frames[f"{player.name}, {camera.lower()}"] = report

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Keep what there is."""

    def approach(self, cycle: float) -> CourseApproach | None:
        """Approach of the pursuer over the last gait cycle.

        Args:
            cycle: Its duration, in [s].

        Returns:
            The approach; None before the first cycle has passed.
        """
        if not self.offsets:
            return None
        now, x, y = self.offsets[-1]
        for time, was_x, was_y in reversed(self.offsets):
            if now - time > cycle - 0.5 * PERIOD:
                return approach_between((was_x, was_y), (x, y), now - time)
        return None

    def _trace(self, name: str, place: tuple[float, float]) -> None:
        self.traces.setdefault(name, deque(maxlen=TRACE)).append(place)
