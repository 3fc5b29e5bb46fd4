"""A player's mind, as it is on board of a robot."""

from collections.abc import Callable

from ..control import ControlScheme
from ..control.assembly import build_scheme
from ..control.balance.settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..strategies import Strategy

REQUEST_TO_MOTION = 3  # ticks, as three teams measured on NAO


def mind_maker(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay_ticks: int = REQUEST_TO_MOTION,
) -> Callable[[Strategy], ControlScheme]:
    """What makes a new mind for every walk.

    Args:
        description: The robot.
        gait: How it walks.
        control: How it controls its walk.
        tick: Control period, in [s].
        delay_ticks: Ticks from a request to the motion.
    """

    def make(strategy: Strategy) -> ControlScheme:
        return build_scheme(
            strategy,
            description,
            gait,
            control,
            tick=tick,
            delay=delay_ticks * tick,
        )

    return make
