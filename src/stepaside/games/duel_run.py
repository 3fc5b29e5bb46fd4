"""A duel that was played, as a value."""

from dataclasses import dataclass
from math import degrees, isfinite
from typing import ClassVar

import numpy as np

from ..arena import Room
from ..core.poses import Array
from ..sim.camera_settings import RoomObject
from .approach_forecast import CourseApproach, approach_between, motion_words
from .duel_circle import angle_between, distance_between, theory_of
from .duel_settings import EVADER, PURSUER, DuelSettings
from .duel_summary import DuelSummary
from .run import Run, SafetyArea
from .trajectory import Trajectory


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DuelRun(Run):
    """A duel that was played; see :class:`Run`.

    Attributes:
        settings: What decided it, with the start that was drawn.
        summary: Its figures.
    """

    game: ClassVar[str] = "duel"
    settings_kind: ClassVar[type[DuelSettings]] = DuelSettings
    summary_kind: ClassVar[type[DuelSummary]] = DuelSummary

    settings: DuelSettings
    summary: DuelSummary

    @property
    def robots(self) -> tuple[str, ...]:
        """Those who are robots; the others are persons."""
        return self.settings.robots

    @property
    def pursuer(self) -> Trajectory:
        """Record of the pursuer."""
        return self.tracks[PURSUER]

    @property
    def evader(self) -> Trajectory:
        """Record of the evader."""
        return self.tracks[EVADER]

    @property
    def distance(self) -> Array:
        """Distance between the places, in [m]. Shape (n,)."""
        return distance_between(self.pursuer.unicycle, self.evader.unicycle)

    @property
    def orientation(self) -> Array:
        """Angle between the headings, in [deg]. Shape (n,)."""
        angle = angle_between(self.pursuer.unicycle, self.evader.unicycle)
        degs: Array = np.degrees(angle)
        return degs

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] of theory's circle."""
        circle, told = theory_of(self.settings), self.summary
        off = told.theory.expected == "contact" and told.converged_at_s is None
        if not circle.exists or off:
            return None
        return (
            circle.radius_evader_m,
            circle.distance_m,
            degrees(circle.headings_apart_rad),
        )

    @property
    def circle(self) -> tuple[float, float, float] | None:
        """Theory's circle, round where the players went in the end.

        Returns:
            Center (x, y) in the world and radius, in [m]; None if they were
            never on it.
        """
        theory, since = self.theory, self.summary.converged_at_s
        if theory is None or since is None:
            return None
        tail = self.times >= since
        middles = [
            track.unicycle[tail, :2].mean(axis=0)
            for track in self.tracks.values()
        ]
        x, y = np.mean(middles, axis=0).tolist()
        return x, y, theory[0]

    @property
    def safety(self) -> SafetyArea | None:
        """Area that the evader keeps free; None if it always evades."""
        radius = self.settings.strategy.area
        return SafetyArea(EVADER, radius) if isfinite(radius) else None

    @property
    def plan(self) -> Room | None:
        """Room that they play in, if they play in one."""
        return self.settings.room.plan

    @property
    def things(self) -> tuple[RoomObject, ...]:
        """What stands about."""
        return tuple(self.settings.room.things)

    def words(self, index: int) -> str:
        """What goes on at a sample."""
        time = float(self.times[index])
        triggered = self.summary.triggered_at_s
        converged = self.summary.converged_at_s
        if self.has_ended_at(index):
            return self.message
        pushed = self.pushed_at(time)
        if pushed:
            return f"the {' and the '.join(pushed)} is pushed"
        if triggered is None or time < triggered:
            moves = motion_words(self._approach_at(index))
            return f"the pursuer {moves}; the evader stands"
        if time < triggered + 1.0:
            return "the evader is triggered"
        if converged is not None and time >= converged:
            return f"{self.settings.both} are on the circle"
        return "the evader is evading"

    def _approach_at(self, index: int) -> CourseApproach | None:
        """Approach at a sample, over the gait cycle before it."""
        if len(self.times) < 2:
            return None
        # The first samples have no cycle before them: the first one counts.
        last = max(index, self.index_at(self.times[0] + self.settings.cycle))
        first = self.index_at(self.times[last] - self.settings.cycle)
        offsets = [
            self.pursuer.unicycle[i, :2] - self.evader.unicycle[i, :2]
            for i in (first, last)
        ]
        (x, y), (now_x, now_y) = (offset.tolist() for offset in offsets)
        elapsed = float(self.times[last] - self.times[first])
        return approach_between((x, y), (now_x, now_y), elapsed)
