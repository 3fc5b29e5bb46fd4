"""Settings of a player at a robot."""

from dataclasses import dataclass
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.setting import check_settings, setting
from ..locomotion.control_settings import ControlSettings
from ..planning import GaitSettings
from ..strategies import Evasion
from ..strategies.registry import check_strategy_name
from .duel_settings import EVADER, PLAYERS, PURSUER, RobotSettings
from .implied_settings import EVASION

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
    plays: str = setting(EVASION, "Strategy of the player")
    strategy: Evasion = setting(Evasion(), "Settings of the strategy")
    gait: GaitSettings = setting(
        GaitSettings(), "Gait, or the template by which velocities are chosen"
    )
    control: ControlSettings = setting(
        ControlSettings(), "Walking control, where joints are commanded"
    )
    dry_run: bool = setting(False, "Whether no commands were sent")

    def __post_init__(self) -> None:
        """Validate strategy, role and language."""
        check_settings(self)
        check_strategy_name(self.plays, "plays")

    @property
    def other(self) -> str:
        """Role of the opponent."""
        return PURSUER if self.role == EVADER else EVADER

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control; the same is assumed of both."""
        return RobotSettings(self.robot, self.gait, self.control)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration
