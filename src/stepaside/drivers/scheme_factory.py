"""Control schemes and perception for a player on board a robot."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ..control.scheme import ControlScheme
from ..control.scheme_builder import build_scheme
from ..control.sight_sources import (
    CameraSight,
    MeasuredSight,
    SightSource,
)
from ..control.strategy_runner import StrategyRunner
from ..core.errors import ConfigurationError, ModelError
from ..locomotion.policy.contract import PolicyContract
from ..locomotion.policy.legs_loader import load_legs
from ..locomotion.policy.legs_settings import LegsSettings
from ..locomotion.policy.policy_walk import PolicyWalk
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..strategies import Strategy
from .joint_body import MotorGains
from .joint_robot import Motors
from .robot_camera import HeadLimits

if TYPE_CHECKING:
    from ..perception.pipeline import Perception

# Of a camera that is fixed on the robot: its head is not commanded.
FIXED_HEAD = HeadLimits(1.0, 1.0, 1.0)
REQUEST_TO_MOTION = 3  # ticks from command to motion, measured on NAO


def control_scheme_factory(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay_ticks: int = REQUEST_TO_MOTION,
    sees_as: str | None = None,
) -> Callable[[Strategy], ControlScheme]:
    """Return a factory of control schemes, one for each walk.

    Args:
        description: Description of the robot.
        gait: Gait settings.
        control: Control settings.
        tick: Control period, in [s].
        delay_ticks: Ticks from a joint command to the motion.
        sees_as: Role of the player if it uses cameras; None if sightings
            come with the measurements.

    Raises:
        ConfigurationError: If cameras are used without OpenCV installed.
        ModelError: If cameras are used and the robot has no head.
    """
    perceive = None if sees_as is None else perception_factory(sees_as)

    def make(strategy: Strategy) -> ControlScheme:
        return build_scheme(
            strategy,
            description,
            gait,
            control,
            tick=tick,
            delay=delay_ticks * tick,
            senses=None
            if perceive is None
            else CameraSight(perceive(description, tick), tick=tick),
        )

    return make


def policy_scheme_factory(
    description: RobotDescription,
    legs: LegsSettings,
    gait: GaitSettings,
    *,
    tick: float,
    sees_as: str | None = None,
) -> Callable[[Strategy], ControlScheme]:
    """Return a factory of control schemes on learned legs.

    The robot must measure joint velocities and take the gains of
    :func:`policy_gains`.

    Args:
        description: Description of the robot.
        legs: Walking policy.
        gait: Speed, steering gain and decision interval of the template.
        tick: Control period, in [s]; it divides the period of the policy.
        sees_as: Role of the player if it uses cameras; None if sightings
            come with the measurements.

    Raises:
        PolicyError: If the network cannot run on the robot.
        ConfigurationError: If cameras are used without OpenCV installed.
        ModelError: If cameras are used and the robot has no head.
    """
    perceive = None if sees_as is None else perception_factory(sees_as)
    load_legs(legs, description, tick=tick)  # refuses before the first walk

    def make(strategy: Strategy) -> ControlScheme:
        walk = PolicyWalk(load_legs(legs, description, tick=tick), gait)
        runner = StrategyRunner(strategy, gait, velocities=walk.velocities)
        senses: SightSource = MeasuredSight()
        if perceive is not None:
            senses = CameraSight(perceive(description, tick), tick=tick)
        return ControlScheme(runner, walk, senses)

    return make


def policy_gains(contract: PolicyContract, motors: Motors) -> MotorGains:
    """Return the gains with which a policy moves the motors of a robot.

    Args:
        contract: Contract of the policy.
        motors: Motors of the robot, with gains of those that the policy
            does not move.

    Raises:
        ModelError: If the robot has no motor for a joint of the policy.
    """
    stiffness, damping = motors.stiffness.copy(), motors.damping.copy()
    for name, own in zip(
        contract.joints,
        zip(contract.stiffness, contract.damping, strict=True),
        strict=True,
    ):
        if name not in motors.names:
            raise ModelError(
                f"joint {name!r} has no motor; there are "
                f"{', '.join(motors.names)}"
            )
        at = motors.names.index(name)
        stiffness[at], damping[at] = own
    return MotorGains(stiffness, damping)


def perception_factory(
    role: str,
) -> "Callable[[RobotDescription, float], Perception]":
    """Return a factory of perception from description and period [s].

    Args:
        role: Role of the player; its opponent's colours are looked for.

    Raises:
        ConfigurationError: If OpenCV is not installed.
        ModelError: If the robot has no head; raised by the factory.
    """
    _one_thread()
    from ..perception.colour_detector import LOOKS, ColourDetector
    from ..perception.pipeline import build_perception
    from ..robots.head import load_head

    def make(description: RobotDescription, tick: float) -> "Perception":
        head, detector = load_head(description), ColourDetector(LOOKS[role])
        return build_perception(description, head, detector, tick=tick)

    return make


def posed_perception_factory(
    role: str,
) -> "Callable[[HeadLimits | None, float], Perception]":
    """Return a factory of perception from the range of a head and a period.

    For robots that give the poses of their cameras.

    Args:
        role: Role of the player; its opponent's colours are looked for.

    Raises:
        ConfigurationError: If OpenCV is not installed.
    """
    _one_thread()
    from ..perception.colour_detector import LOOKS, ColourDetector
    from ..perception.pipeline import build_posed_perception

    def make(head: HeadLimits | None, tick: float) -> "Perception":
        yaw, up, down = head or FIXED_HEAD
        return build_posed_perception(
            ColourDetector(LOOKS[role]),
            np.array([[-yaw, yaw], [-up, -up], [down, down]]),
            tick=tick,
        )

    return make


def _one_thread() -> None:
    """Restrict OpenCV to one thread, as walking needs the other cores."""
    try:
        import cv2
    except ImportError as error:
        raise ConfigurationError(
            "sensing with cameras needs OpenCV: pip install "
            "'stepaside[vision]'"
        ) from error
    cv2.setNumThreads(1)
