"""Recorded play of one player at a robot."""

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
    """Recorded play of one player; see :class:`Run`.

    The frame of its trajectories is the player's own odometry. The opponent
    is at its last sighting and is drawn as a template that faces the player,
    as its heading is unknown.

    Attributes:
        settings: Settings of the player.
        summary: Its summary.
    """

    game: ClassVar[str] = "play"
    settings_kind: ClassVar[type[PlaySettings]] = PlaySettings
    summary_kind: ClassVar[type[PlaySummary]] = PlaySummary

    settings: PlaySettings
    summary: PlaySummary

    @property
    def title(self) -> str:
        """Title, for figures and pages."""
        settings = self.settings
        return f"Play of the {settings.role} over {settings.language}"

    @property
    def player(self) -> Trajectory:
        """Trajectory of the player itself."""
        return self.tracks[self.settings.role]

    @property
    def persons(self) -> tuple[str, ...]:
        """Empty: the opponent is drawn as a template."""
        return ()

    @property
    def orientation(self) -> Array | None:
        """None: the heading of the opponent is unknown."""
        return None

    @property
    def safety(self) -> SafetyArea | None:
        """Safety area of an evader; None for a pursuer."""
        radius = self.settings.strategy.area
        evades = self.settings.role == EVADER and isfinite(radius)
        return SafetyArea(EVADER, radius) if evades else None

    def words(self, index: int) -> str:
        """Describe the state of the player at a sample, for captions."""
        if self.has_ended_at(index):
            return self.message
        time = float(self.times[index]) + 1e-9
        text = "no state recorded yet"
        for change in self.summary.changes:
            if change.time_s <= time:
                text = f"{change.state} ({change.reason})"
        return text
