"""A player's mind, as it is on board of a robot."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from ..control import ControlScheme
from ..control.scheme_builder import build_scheme
from ..core.errors import ConfigurationError
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..strategies import Strategy

if TYPE_CHECKING:
    from ..perception.perception import Perception
    from ..perception.planar_perception import PlanarPerception

REQUEST_TO_MOTION = 3  # ticks, as three teams measured on NAO


def mind_maker(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay_ticks: int = REQUEST_TO_MOTION,
    sees_as: str | None = None,
) -> Callable[[Strategy], ControlScheme]:
    """What makes a new mind for every walk.

    Args:
        description: The robot.
        gait: How it walks.
        control: How it controls its walk.
        tick: Control period, in [s].
        delay_ticks: Ticks from a request to the motion.
        sees_as: Role of who sees with cameras; None if sightings come with
            the measurements.

    Raises:
        ConfigurationError: If it is to see and OpenCV is not there.
        ModelError: If it is to see and has no head.
    """
    perceive = None if sees_as is None else perception_of(sees_as)

    def make(strategy: Strategy) -> ControlScheme:
        return build_scheme(
            strategy,
            description,
            gait,
            control,
            tick=tick,
            delay=delay_ticks * tick,
            perception=None
            if perceive is None
            else perceive(description, tick),
        )

    return make


def perception_of(
    role: str,
) -> "Callable[[RobotDescription, float], Perception]":
    """What makes the perception of a role, at a control period in [s].

    Args:
        role: Who looks.

    Raises:
        ConfigurationError: If OpenCV is not there.
    """
    _one_thread()
    from ..perception.colour_detector import LOOKS
    from ..perception.perception import Perception
    from ..robots.head import load_head

    def make(description: RobotDescription, tick: float) -> Perception:
        head = load_head(description)
        return Perception(description, head, LOOKS[role], tick=tick)

    return make


def level_perception(
    role: str, description: RobotDescription, tick: float
) -> "PlanarPerception":
    """Perception of a role at a robot that walks by itself.

    Args:
        role: Who looks.
        description: The robot.
        tick: Time between two reports, in [s].

    Raises:
        ConfigurationError: If OpenCV is not there.
        ModelError: If the robot has no head.
    """
    _one_thread()
    from ..perception.colour_detector import LOOKS
    from ..perception.planar_perception import PlanarPerception
    from ..robots.head import load_head

    head = load_head(description)
    return PlanarPerception(description, head, LOOKS[role], tick=tick)


def _one_thread() -> None:
    """Let OpenCV take one core, which sees and walks."""
    try:
        import cv2
    except ImportError as error:
        raise ConfigurationError(
            "sensing with cameras needs OpenCV: pip install "
            "'stepaside[vision]'"
        ) from error
    cv2.setNumThreads(1)
