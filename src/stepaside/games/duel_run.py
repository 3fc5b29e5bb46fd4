"""Recorded duel."""

from dataclasses import dataclass
from math import degrees, isfinite
from typing import ClassVar

import numpy as np

from ..arena import Room
from ..core.poses import Array
from ..sim.camera_settings import RoomObject
from .approach_forecast import (
    CourseApproach,
    describe_motion,
    estimate_approach,
)
from .duel_circle import angle_between, circle_of_theory, distance_between
from .duel_settings import EVADER, PURSUER, DuelSettings
from .duel_summary import DuelSummary
from .run import Run, SafetyArea
from .trajectory import Trajectory


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DuelRun(Run):
    """Recorded duel; see :class:`Run`.

    Attributes:
        settings: Settings of the duel, with the initial poses filled in.
        summary: Its summary.
    """

    game: ClassVar[str] = "duel"
    settings_kind: ClassVar[type[DuelSettings]] = DuelSettings
    summary_kind: ClassVar[type[DuelSummary]] = DuelSummary

    settings: DuelSettings
    summary: DuelSummary

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players that are robots; the others are persons."""
        return self.settings.robots

    @property
    def pursuer(self) -> Trajectory:
        """Trajectory of the pursuer."""
        return self.tracks[PURSUER]

    @property
    def evader(self) -> Trajectory:
        """Trajectory of the evader."""
        return self.tracks[EVADER]

    @property
    def distance(self) -> Array:
        """Distance between the reference points, in [m]. Shape (n,)."""
        return distance_between(self.pursuer.unicycle, self.evader.unicycle)

    @property
    def orientation(self) -> Array:
        """Angle between the headings, in [deg]. Shape (n,)."""
        angle = angle_between(self.pursuer.unicycle, self.evader.unicycle)
        in_degrees: Array = np.degrees(angle)
        return in_degrees

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] on the circle of theory.

        None if there is no circle, or the forecast was contact before it.
        """
        circle, summary = circle_of_theory(self.settings), self.summary
        converged = summary.converged_at_s is not None
        if summary.theory.expected == "contact" and not converged:
            return None
        if not circle.exists:
            return None
        return (
            circle.radius_evader_m,
            circle.distance_m,
            degrees(circle.headings_apart_rad),
        )

    @property
    def circle(self) -> tuple[float, float, float] | None:
        """Circle of theory, centered where the players walked in the end.

        Returns:
            Center (x, y) in the world and radius, in [m]; None if the
            players did not converge to it.
        """
        theory, since = self.theory, self.summary.converged_at_s
        if theory is None or since is None:
            return None
        tail = self.times >= since
        centers = [
            track.unicycle[tail, :2].mean(axis=0)
            for track in self.tracks.values()
        ]
        x, y = np.mean(centers, axis=0).tolist()
        return x, y, theory[0]

    @property
    def safety(self) -> SafetyArea | None:
        """Safety area of the evader; None if it always evades."""
        radius = self.settings.strategy.area
        return SafetyArea(EVADER, radius) if isfinite(radius) else None

    @property
    def plan(self) -> Room | None:
        """Room of the game; None on an open floor."""
        return self.settings.room.plan

    @property
    def things(self) -> tuple[RoomObject, ...]:
        """Objects in the room."""
        return tuple(self.settings.room.things)

    def words(self, index: int) -> str:
        """Describe the state of the game at a sample, for captions."""
        time = float(self.times[index])
        triggered = self.summary.triggered_at_s
        converged = self.summary.converged_at_s
        if self.has_ended_at(index):
            return self.message
        pushed = self.pushed_at(time)
        if pushed:
            return f"the {' and the '.join(pushed)} is pushed"
        if triggered is None or time < triggered:
            moves = describe_motion(self._approach_at(index))
            return f"the pursuer {moves}; the evader stands"
        if time < triggered + 1.0:
            return "the evader is triggered"
        if converged is not None and time >= converged:
            return f"{self.settings.both} are on the circle"
        return "the evader is evading"

    def _approach_at(self, index: int) -> CourseApproach | None:
        """Return the approach over the gait cycle before a sample."""
        if len(self.times) < 2:
            return None
        # Before one cycle has passed, use the first complete cycle.
        last = max(index, self.index_at(self.times[0] + self.settings.cycle))
        first = self.index_at(self.times[last] - self.settings.cycle)
        offsets = [
            self.pursuer.unicycle[i, :2] - self.evader.unicycle[i, :2]
            for i in (first, last)
        ]
        (x, y), (now_x, now_y) = (offset.tolist() for offset in offsets)
        elapsed = float(self.times[last] - self.times[first])
        return estimate_approach((x, y), (now_x, now_y), elapsed)
