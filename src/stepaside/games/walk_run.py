"""Recorded walk."""

from dataclasses import dataclass
from typing import ClassVar

from .run import Run
from .trajectory import Trajectory
from .walk_settings import WalkSettings
from .walk_summary import WalkSummary


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class WalkRun(Run):
    """Recorded walk; see :class:`Run`.

    Attributes:
        settings: Settings of the walk.
        summary: Its summary.
    """

    game: ClassVar[str] = "walk"
    settings_kind: ClassVar[type[WalkSettings]] = WalkSettings
    summary_kind: ClassVar[type[WalkSummary]] = WalkSummary

    settings: WalkSettings
    summary: WalkSummary

    @property
    def walker(self) -> Trajectory:
        """Trajectory of the robot."""
        return next(iter(self.tracks.values()))

    def words(self, index: int) -> str:
        """Describe the state of the robot at a sample, for captions."""
        time = float(self.times[index])
        if self.has_ended_at(index):
            return self.message
        if self.pushed_at(time):
            return "the robot is pushed"
        if self.stands_until is None or time < self.stands_until:
            return "the robot stands"
        return "the robot walks"

    @property
    def stands_until(self) -> float | None:
        """Time of the first lift-off of a foot, in [s]; None without any."""
        landings = self.walker.landings
        if landings is None or not len(landings):
            return None
        return float(landings[0, 0]) - self.settings.gait.single_support
