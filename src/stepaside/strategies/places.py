"""Where both players are when a maneuver begins that is tried."""

from math import cos, sin

from ..poses import Pose
from ..steps import Both
from .knowledge import Knowledge
from .other import Trace


def place_both(trace: Trace, heading: float) -> Both:
    """Where both are, in the own odometry.

    Args:
        trace: At least one sighting.
        heading: Of the pursuer there, in [rad].
    """
    seen = trace[-1]
    return Both(
        seen.own_x,
        seen.own_y,
        cos(seen.own_theta),
        sin(seen.own_theta),
        seen.x,
        seen.y,
        cos(heading),
        sin(heading),
    )


def moved_on(both: Both, knowledge: Knowledge, begins: Pose) -> Both:
    """Where both are when the step begins that is decided.

    A body passes the foot that landed half a step after it did, and the
    pursuer has gone on as long.

    Args:
        both: Where they were when the pursuer was seen.
        knowledge: Of the own limits, and how long ago that was.
        begins: Where the step begins, in the own odometry.
    """
    limits = knowledge.limits
    steps = 0.5 + knowledge.age / limits.step_duration
    way = limits.stride * steps
    return Both(
        begins.x,
        begins.y,
        cos(begins.theta),
        sin(begins.theta),
        both.px + way * both.pc,
        both.py + way * both.ps,
        both.pc,
        both.ps,
    )
