r"""How much push a step can take: the bound of the linear inverted pendulum.

An impulse J at the CoM moves the DCM by :math:`J / (m \eta)` from the plan's.
From there the difference :math:`\delta` obeys
:math:`\dot{\delta} = \eta (\delta - p)`, where p, the difference of the ZMP
from the plan's, stays in the sole: in single support for the time T that is
left; in double support, which lasts D, between the old sole and the new one,
which may land a way :math:`\Delta` from where it was planned. The push can be
held if the rest lies in the new sole. Along each axis of the support foot the
greatest difference that can be held is then

.. math:: (1 - e^{-\eta T}) p + e^{-\eta (T + D)}
   (A\, p + B\, (\Delta + q) + \Delta + q),

with p and q the edges of the old and the new sole, and A, B the weights of
a ZMP that moves linearly from one to the other.
"""

from math import cos, exp, inf, sin
from typing import NamedTuple

from ..errors import PlanError, check_positive, check_within
from .footsteps import Foot
from .plan import ManeuverPlan
from .settings import GaitSettings

Interval = tuple[float, float]


class Reach(NamedTuple):
    """Where a foot can land, in the frame of the support foot.

    Attributes:
        forward: Farthest ahead, in [m].
        backward: Farthest behind, in [m].
        outward: How much farther than the foot spacing to the side, in [m].
        gap: Least distance between soles that stand abreast, in [m].
        edge: Distance that the ZMP keeps from the edge of a sole, in [m].
    """

    forward: float
    backward: float
    outward: float
    gap: float
    edge: float = 0.0


def push_bound(
    plan: ManeuverPlan,
    passed: float,
    direction: float,
    mass: float,
    reach: Reach,
) -> float:
    """Largest impulse that the pendulum can hold with one footstep.

    Args:
        plan: Plan that begins with a single support.
        passed: Time since it began, within its first step, in [s].
        direction: Of the push in the plan frame, in [rad].
        mass: Of the robot, in [kg].
        reach: Where the foot can land.

    Returns:
        Impulse, in [N s].

    Raises:
        PlanError: If the plan starts from standing, or the time lies beyond
            its first step.
    """
    gait = plan.schedule.settings
    if plan.schedule.standing:
        raise PlanError("plan must begin with a single support, got standing")
    check_positive(mass, "mass", "kg")
    check_within(passed, 0.0, gait.step_duration, "passed", "s")
    held = _held(plan, passed, reach)
    most = inf
    for (low, high), along in zip(
        held, (cos(direction), sin(direction)), strict=True
    ):
        if along > 1e-9:
            most = min(most, high / along)
        elif along < -1e-9:
            most = min(most, low / along)
    return max(0.0, mass * gait.eta * most)


def _held(plan: ManeuverPlan, passed: float, reach: Reach) -> list[Interval]:
    """Differences of the DCM that can be held, along x and y, in [m]."""
    gait = plan.schedule.settings
    swing = plan.first_foot
    own, other = _sole(swing, gait, reach), _sole(swing.other, gait, reach)
    rest = gait.single_support - passed
    if rest >= 0.0:
        moves = _moves(plan, reach, swing)
        return [
            _through(own[i], other[i], moves[i], rest, 0.0, gait)
            for i in (0, 1)
        ]
    # The foot stands already: the next one is the footstep.
    share = -rest / gait.double_support
    moves = _moves(plan, reach, swing.other)
    single = gait.single_support
    then = [
        _through(other[i], own[i], moves[i], single, 0.0, gait) for i in (0, 1)
    ]
    return [_double(own[i], other[i], then[i], share, gait) for i in (0, 1)]


def _through(
    old: Interval,
    new: Interval,
    moves: Interval,
    single: float,
    share: float,
    gait: GaitSettings,
) -> Interval:
    """Held at a time before the end of a single support."""
    fade = exp(-gait.eta * single)
    landed = _double(
        old,
        (new[0] + moves[0], new[1] + moves[1]),
        (new[0] + moves[0], new[1] + moves[1]),
        share,
        gait,
    )
    return (
        (1.0 - fade) * old[0] + fade * landed[0],
        (1.0 - fade) * old[1] + fade * landed[1],
    )


def _double(
    old: Interval,
    new: Interval,
    then: Interval,
    share: float,
    gait: GaitSettings,
) -> Interval:
    """Held in a double support of which a share has passed.

    Args:
        old: ZMP differences that the old sole allows.
        new: Those of the new one.
        then: What can be held at its end.
        share: Part of the double support that has passed.
        gait: Gait.
    """
    left = (1.0 - share) * gait.double_support
    grown = gait.eta * left
    if grown < 1e-9:
        return then
    fade = exp(-grown)
    # Weights of a ZMP that goes from the old to the new sole in what is left.
    to_new = (1.0 - fade) / grown - fade
    to_old = 1.0 - fade - to_new
    start = [
        (1.0 - share) * a + share * b for a, b in zip(old, new, strict=True)
    ]
    low, high = (
        to_old * start[i] + to_new * new[i] + fade * then[i] for i in (0, 1)
    )
    return low, high


def _sole(
    swing: Foot, gait: GaitSettings, reach: Reach
) -> tuple[Interval, Interval]:
    """ZMP differences under the foot that supports, along x and y."""
    sole, ahead, edge = gait.sole, gait.zmp_forward, reach.edge
    outer, inner = sole.outer - edge, sole.inner - edge
    right, left = (inner, outer) if swing is Foot.RIGHT else (outer, inner)
    x = (sole.back + edge - ahead, sole.front - edge - ahead)
    return x, (-right, left)


def _moves(
    plan: ManeuverPlan, reach: Reach, swing: Foot
) -> tuple[Interval, Interval]:
    """How far a landing can be moved, along x and y."""
    gait, side = plan.schedule.settings, swing.value
    x, y, _ = plan.placements[2].tolist()
    near = 2.0 * gait.sole.inner + reach.gap - abs(y)
    far = gait.foot_spacing + reach.outward - abs(y)
    aside = (near, far) if side > 0 else (-far, -near)
    return (-reach.backward - x, reach.forward - x), aside
