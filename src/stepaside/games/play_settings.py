"""Settings of a player at a robot."""

from dataclasses import dataclass, replace
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.setting import check_settings, setting
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import PRESETS, GaitSettings
from ..sim.camera_settings import CameraSettings
from ..strategies import Evasion
from ..strategies.registry import check_strategy_name
from ..strategies.shield_settings import ShieldSettings
from .player_settings import (
    EVADER,
    EVASION,
    PLAYERS,
    PURSUER,
    STRATEGY_NAMES,
    PlayerSettings,
)

LANGUAGES = LOLA, NAOQI, ROS2, PYTHON, RCSS = (
    *("lola", "naoqi", "ros2"),
    *("python", "rcss"),
)


@dataclass(frozen=True, slots=True)
class PlaySettings:
    """Settings of one player at one robot."""

    game: ClassVar[str] = "play"
    __repr__ = brief_repr

    role: str = setting(EVADER, "Role of the player", names=PLAYERS)
    language: str = setting(LOLA, "Protocol of the robot", names=LANGUAGES)
    robot: str = setting(
        "nao", "Name of the robot, or folder of its description"
    )
    strategy: str = setting(
        "",
        f"Strategy of the player: {STRATEGY_NAMES}",
        default_text="that of the paper",
    )
    evasion: Evasion = setting(
        Evasion(),
        "Settings of the paper's evasion strategy",
        needs=("strategy", EVASION),
    )
    shield: ShieldSettings = setting(
        ShieldSettings(), "Shield of the player", needs=("shield.enabled", "")
    )
    gait: GaitSettings = setting(
        GaitSettings(),
        "Gait, or the template by which velocities are chosen",
        presets=PRESETS,
    )
    control: ControlSettings = setting(
        ControlSettings(), "Walking control, where joints are commanded"
    )
    legs: LegsSettings = setting(LegsSettings(), "Learned legs")
    senses: str = setting(
        "ideal",
        "Sensing of the opponent: as the robot reports it (ideal), or "
        "detection in camera images",
        names=("ideal", "cameras"),
    )
    cameras: CameraSettings = setting(
        CameraSettings(),
        "Cameras, with camera sensing",
        needs=("senses", "cameras"),
    )
    dry_run: bool = setting(False, "Whether no commands were sent")

    def __post_init__(self) -> None:
        """Validate strategy, role and language."""
        check_settings(self)
        if self.strategy:
            check_strategy_name(self.strategy)

    @property
    def other(self) -> str:
        """Role of the opponent."""
        return PURSUER if self.role == EVADER else EVADER

    def player(self, name: str) -> PlayerSettings:
        """Return robot, gait and control; the same is assumed of both."""
        return PlayerSettings(
            name,
            self.role,
            robot=self.robot,
            gait=self.gait,
            control=self.control,
            legs=self.legs,
            strategy=self.strategy,
            evasion=self.evasion,
            shield=self.shield,
        )

    def resolved(self) -> "PlaySettings":
        """Return the settings with nothing left open."""
        own = self.player(self.role).resolved()
        return replace(
            self,
            strategy=own.strategy,
            evasion=own.evasion,
            control=own.control,
        )

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration
