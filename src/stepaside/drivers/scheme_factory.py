"""Control schemes and perception for a player on board a robot."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ..control.scheme import ControlScheme, build_walk
from ..control.sensor_sight import CameraSight
from ..core.errors import ConfigurationError, ModelError
from ..core.poses import Array
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..locomotion.policy.contract import PolicyContract
from ..locomotion.policy.policy_legs import PolicyWalk, load_legs
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..strategies import Strategy
from .joint_motion import Motors
from .robot import HeadLimits

if TYPE_CHECKING:
    from ..perception.colour_detector import ColourDetector
    from ..perception.pipeline import Perception

# Of a camera that is fixed on the robot: its head is not commanded.
FIXED_HEAD = HeadLimits(1.0, 1.0, 1.0)
REQUEST_TO_MOTION = 3  # ticks from command to motion, measured on NAO


def scheme_factory(
    description: RobotDescription,
    gait: GaitSettings,
    walks_by: ControlSettings | LegsSettings,
    *,
    tick: float,
    delay_ticks: int = REQUEST_TO_MOTION,
    sees_as: str | None = None,
) -> Callable[[Strategy], ControlScheme]:
    """Return a factory of control schemes, one for each walk.

    It walks by the paper's control or by a policy, whose period the tick [s]
    divides. A role means that the player uses cameras; else sightings come
    with the measurements.
    """
    detector = None if sees_as is None else _detector(sees_as)
    if isinstance(walks_by, LegsSettings):
        load_legs(walks_by, description, tick=tick)  # refuses before a walk

    def make(strategy: Strategy) -> ControlScheme:
        senses: CameraSight | None = None
        if detector is not None:
            from ..perception.pipeline import build_perception
            from ..robots.head import load_head

            perception = build_perception(
                description, load_head(description), detector, tick=tick
            )
            senses = CameraSight(perception, tick=tick)
        if isinstance(walks_by, LegsSettings):
            legs = load_legs(walks_by, description, tick=tick)
            return ControlScheme(strategy, PolicyWalk(legs, gait), senses)
        walk = build_walk(
            *(description, gait, walks_by),
            tick=tick,
            delay=delay_ticks * tick,
            forward=None if senses is None else senses.forward,
        )
        return ControlScheme(strategy, walk, senses)

    return make


def policy_gains(
    contract: PolicyContract, motors: Motors
) -> tuple[Array, Array]:
    """Return stiffness and damping with which a policy moves motors."""
    stiffness, damping = motors.stiffness.copy(), motors.damping.copy()
    for name, *own in zip(
        contract.joints, contract.stiffness, contract.damping, strict=True
    ):
        if name not in motors.names:
            raise ModelError(
                f"joint {name!r} has no motor; there are "
                f"{', '.join(motors.names)}"
            )
        at = motors.names.index(name)
        stiffness[at], damping[at] = own
    return stiffness, damping


def posed_perception(
    role: str, head: HeadLimits | None, tick: float
) -> "Perception":
    """Return the perception of a robot that gives the poses of its camera."""
    detector = _detector(role)
    from ..perception.pipeline import build_posed_perception

    yaw, up, down = head or FIXED_HEAD
    limits = np.array([[-yaw, yaw], [-up, -up], [down, down]])
    return build_posed_perception(detector, limits, tick=tick)


def _detector(role: str) -> "ColourDetector":
    """Return a detector of the colours of a role's opponent.

    OpenCV is restricted to one thread, as walking needs the other cores.
    """
    try:
        import cv2
    except ImportError as error:
        raise ConfigurationError(
            "sensing with cameras needs OpenCV: pip install "
            "'stepaside[vision]'"
        ) from error
    cv2.setNumThreads(1)
    from ..perception.colour_detector import LOOKS, ColourDetector

    return ColourDetector(LOOKS[role])
