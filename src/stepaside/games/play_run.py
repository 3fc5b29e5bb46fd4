"""What a player at a robot left behind, as a value."""

from dataclasses import dataclass
from math import isfinite
from typing import ClassVar

from ..core.poses import Array
from .duel_settings import EVADER
from .play_settings import PlaySettings
from .play_summary import PlaySummary
from .run import Run, SafetyArea
from .trajectory import Trajectory


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PlayRun(Run):
    """What one player knew of a game; see :class:`Run`.

    The world of its tracks is its own odometry. The other is where it was
    seen last, and is drawn as a template that faces who saw it: how it
    truly headed nobody knows.

    Attributes:
        settings: What it was told.
        summary: Its figures.
    """

    game: ClassVar[str] = "play"
    settings_kind: ClassVar[type[PlaySettings]] = PlaySettings
    summary_kind: ClassVar[type[PlaySummary]] = PlaySummary

    settings: PlaySettings
    summary: PlaySummary

    @property
    def title(self) -> str:
        """What it was, in a few words."""
        settings = self.settings
        return f"Play of the {settings.role} over {settings.language}"

    @property
    def player(self) -> Trajectory:
        """Record of who played."""
        return self.tracks[self.settings.role]

    @property
    def persons(self) -> tuple[str, ...]:
        """Nobody: what is no robot is drawn as a template."""
        return ()

    @property
    def orientation(self) -> Array | None:
        """Nothing: how the other headed is not known."""
        return None

    @property
    def safety(self) -> SafetyArea | None:
        """Area that an evader keeps free, if there is one."""
        radius = self.settings.strategy.area
        evades = self.settings.role == EVADER and isfinite(radius)
        return SafetyArea(EVADER, radius) if evades else None

    def words(self, index: int) -> str:
        """What goes on at a sample."""
        if self.has_ended_at(index):
            return self.message
        time = float(self.times[index]) + 1e-9
        said = "nothing is known yet"
        for change in self.summary.changes:
            if change.time_s <= time:
                said = f"{change.state} ({change.reason})"
        return said
