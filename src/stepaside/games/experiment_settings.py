"""Settings of an experiment: motion of players that was recorded elsewhere."""

from dataclasses import dataclass
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError
from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting
from ..planning import GaitSettings
from .player_settings import PlayerSettings


@dataclass(frozen=True, slots=True)
class ExperimentSettings(CheckedSettings):
    """Settings of an experiment: its recording, and who is who in it."""

    game: ClassVar[str] = "experiment"
    __repr__ = brief_repr

    source: str = setting("", "Name of the recording")
    frames: tuple[str, ...] = setting(
        (), "Players, as NAME=FRAME or NAME=/TOPIC"
    )
    world: str = setting("", "Frame in which all poses are")
    cycle: float = setting(
        1.0,
        "Duration of a gait cycle, over which figures average the sway",
        Range(1e-3, 60.0, "s", "any gait"),
    )

    @property
    def gait(self) -> GaitSettings:
        """Gait whose soles figures draw: an experiment has no footsteps."""
        return GaitSettings()

    def player(self, name: str) -> PlayerSettings:
        """Raise an error: the robots of an experiment are not described."""
        raise ConfigurationError(
            f"robot of {name} must be described, but an experiment has "
            "poses only"
        )
