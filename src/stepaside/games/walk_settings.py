"""Settings of a walk: equal settings repeat it exactly."""

from dataclasses import dataclass, replace
from math import pi
from typing import ClassVar

from ..core.brief_repr import brief_repr
from ..core.ranges import (
    RUNTIME,
    SEEDS,
    Range,
    check_count,
)
from ..core.setting import check_settings, setting
from ..locomotion.control_settings import ControlSettings
from ..planning import PRESETS, GaitSettings
from ..sim.body_settings import BODIES, BodySettings
from ..sim.physics_settings import PhysicsSettings
from ..sim.push import MOST_PUSHES, Push, check_pushes
from .duel_settings import RobotSettings
from .implied_settings import implied_control

WALKER = "walker"


@dataclass(frozen=True, slots=True)
class WalkSettings:
    """Settings of a walk."""

    game: ClassVar[str] = "walk"
    __repr__ = brief_repr

    seed: int = setting(
        1,
        "Random seed",
        SEEDS,
    )
    duration: float = setting(
        20.0,
        "Simulated time",
        RUNTIME,
    )
    robot: str = setting(
        "nao",
        "Name of a robot, or folder of its description",
    )
    bearing: float = setting(
        0.0,
        "Desired heading in the frame of the support foot {unit}; 0 is "
        "straight ahead, others walk a circle",
        Range(-pi, pi, "rad", "half a turn"),
    )
    backward: bool = setting(
        False,
        "Walk backward",
    )
    gait: GaitSettings = setting(
        GaitSettings(),
        "Gait",
        presets=PRESETS,
    )
    physics: PhysicsSettings = setting(
        PhysicsSettings(), "Physics, floor and clock"
    )
    body: BodySettings = setting(
        BodySettings(),
        "Deviations of the body from an ideal one",
        presets=BODIES,
    )
    control: ControlSettings = setting(ControlSettings(), "Walking control")
    pushes: tuple[Push, ...] = setting(
        (),
        "Pushes on the robot",
    )

    def __post_init__(self) -> None:
        """Validate ranges and pushes."""
        check_settings(self)
        check_count(self.pushes, MOST_PUSHES, "pushes")
        check_pushes(self.pushes, (WALKER,))

    def resolved(self) -> "WalkSettings":
        """Return the settings of the same walk with nothing left open."""
        control = implied_control(self.control, self.gait, self.body)
        return replace(self, control=control)

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait and control of the walker."""
        return RobotSettings(self.robot, self.gait, self.control)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration
