"""Settings of a walk: equal settings repeat it exactly."""

from dataclasses import dataclass, field
from math import pi
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.ranges import (
    RUNTIME,
    SEEDS,
    Range,
    Ranges,
    check_count,
    check_settings,
)
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..sim.body_settings import BodySettings
from ..sim.physics_settings import PhysicsSettings
from ..sim.push import MOST_PUSHES, Push, check_pushes
from .duel_settings import RobotSettings

WALKER = "walker"


@dataclass(frozen=True, slots=True)
class WalkSettings:
    """Settings of a walk.

    Attributes:
        seed: Seed of every random draw; 0 to 3.40282e+38.
        duration: Simulated time, in [s]; 0.001 to 86400.
        robot: Name of a robot or folder of its description.
        bearing: Desired heading in the frame of each support foot, in [rad]: 0
            for a straight walk, others for a circle; -3.14159 to 3.14159.
        backward: Whether the robot walks backward.
        gait: Gait settings.
        physics: Physics, floor and clock.
        body: Deviations of the body from an ideal one.
        control: Control settings.
        pushes: Pushes on the robot.
    """

    __repr__ = brief_repr

    seed: int = 1
    duration: float = 20.0
    robot: str = "nao"
    bearing: float = 0.0
    backward: bool = False
    gait: GaitSettings = field(default_factory=GaitSettings)
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    body: BodySettings = field(default_factory=BodySettings)
    control: ControlSettings = field(default_factory=ControlSettings)
    pushes: tuple[Push, ...] = ()

    ranges: ClassVar[Ranges] = {
        "seed": SEEDS,
        "duration": RUNTIME,
        "bearing": Range(-pi, pi, "rad", "half a turn"),
    }

    def __post_init__(self) -> None:
        """Validate ranges and pushes."""
        check_settings(self)
        check_count(self.pushes, MOST_PUSHES, "pushes")
        check_pushes(self.pushes, (WALKER,))

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control of the walker.

        Args:
            player: Name of the player.
        """
        return RobotSettings(self.robot, self.gait, self.control)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration
