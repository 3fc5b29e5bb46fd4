"""Settings of a player at a robot."""

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
    """Settings of one player at one robot.

    Attributes:
        role: "pursuer" or "evader".
        language: Protocol of the robot: "lola", "naoqi" or "ros2".
        robot: Name of the robot or folder of its description.
        plays: Strategy of the player.
        strategy: Settings of the strategy.
        gait: Gait, or the template by which velocities are chosen.
        control: Control of the walk, where joints are commanded.
        dry_run: Whether no commands were sent.
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
        """Validate strategy, role and language."""
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
        """Role of the opponent."""
        return PURSUER if self.role == EVADER else EVADER

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control; the same is assumed of both.

        Args:
            player: Name of the player.
        """
        return RobotSettings(self.robot, self.gait, self.control)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration

    @property
    def seed(self) -> int:
        """Zero: a play at a robot draws no random numbers."""
        return 0

    @property
    def physics(self) -> PhysicsSettings:
        """Default physics, of which a replay shows the floor."""
        return PhysicsSettings()

    @property
    def body(self) -> BodySettings:
        """Default body, for a replay."""
        return BodySettings()
