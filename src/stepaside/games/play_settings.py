"""Settings of a player at a robot: what decides how it plays."""

from dataclasses import dataclass, field
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError
from ..core.ranges import Ranges, check_settings
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..sim.body_settings import BodySettings
from ..sim.physics_settings import PhysicsSettings
from ..strategies import Evasion
from ..strategies.registry import check_strategy_name
from .duel_settings import EVADER, PLAYERS, PURSUER, RobotSettings
from .strategy_objects import EVASION

LANGUAGES = LOLA, NAOQI, ROS2 = ("lola", "naoqi", "ros2")


@dataclass(frozen=True, slots=True)
class PlaySettings:
    """What one player at one robot was told.

    Attributes:
        role: Who it is.
        language: How the robot is spoken to.
        robot: Name of the robot or folder of its description.
        plays: Strategy that it plays.
        strategy: Settings of the strategy.
        gait: How it walks, or the template that it drives by.
        control: How it controls its walk, where it moves joints.
        dry_run: Whether nothing was commanded.
    """

    __repr__ = brief_repr

    role: str = EVADER
    language: str = LOLA
    robot: str = "nao"
    plays: str = EVASION
    strategy: Evasion = field(default_factory=Evasion)
    gait: GaitSettings = field(default_factory=GaitSettings)
    control: ControlSettings = field(default_factory=ControlSettings)
    dry_run: bool = False

    ranges: ClassVar[Ranges] = {}

    def __post_init__(self) -> None:
        """Refuse a role and a language that are none."""
        check_settings(self)
        check_strategy_name(self.plays, "plays")
        for name, known in (("role", PLAYERS), ("language", LANGUAGES)):
            if getattr(self, name) not in known:
                raise ConfigurationError(
                    f"{name} must be one of {', '.join(known)}, "
                    f"got {getattr(self, name)!r}"
                )

    @property
    def other(self) -> str:
        """Who it plays with."""
        return PURSUER if self.role == EVADER else EVADER

    def robot_of(self, player: str) -> RobotSettings:
        """What a player is, and how it walks; of the other it is assumed.

        Args:
            player: Its name.
        """
        return RobotSettings(self.robot, self.gait, self.control)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration

    @property
    def seed(self) -> int:
        """Zero: nothing is drawn at a robot."""
        return 0

    @property
    def physics(self) -> PhysicsSettings:
        """Those by which it is drawn: a floor."""
        return PhysicsSettings()

    @property
    def body(self) -> BodySettings:
        """Those by which it is drawn."""
        return BodySettings()
