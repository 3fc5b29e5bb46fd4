r"""Largest push after which the linear inverted pendulum can be held.

An impulse J at the CoM moves the DCM by :math:`J / (m \eta)`. A ZMP whose
mean, weighted by :math:`e^{-\eta t}`, is p takes the DCM over a time T to

.. math:: \xi(T) = e^{\eta T} \xi(0) - (e^{\eta T} - 1)\, p,

so the DCMs that can be brought into a convex set X by ZMPs out of a convex
set P are :math:`e^{-\eta T} X \oplus (1 - e^{-\eta T}) P`, again convex.

A footstep f out of a convex set F brings a sole B + f beside the sole A that
stands. The DCMs that the two feet then hold for good are their hull, and the
union of these hulls over all f is convex, too: it is the hull of A and
:math:`F \oplus B`, for a mean of a in A and b + f in B + f is one of a and
a point of :math:`F \oplus B`.

What this bounds is a pendulum: a point mass at a constant height, with flat
feet of the sole's size, its ZMP anywhere under the feet on the floor and as
fast as it likes, and footsteps that land when planned, parallel to the foot
that stands. Whatever turns the body about its CoM, raises it, or lands at
another time is outside it.
"""

from math import cos, exp, expm1, sin
from typing import NamedTuple

import numpy as np

from ..core.convex import convex_hull
from ..core.errors import (
    check_bearing,
    check_not_negative,
    check_positive,
    check_within,
)
from ..core.poses import Array
from .footsteps import Foot
from .gait_settings import GaitSettings
from .plan import ManeuverPlan
from .support_polygon import sole_corners

MOST_STEPS = 20  # more change nothing: each counts by exp(-eta T)


class FootReach(NamedTuple):
    """Where a footstep may land, in the axes of the support foot.

    Attributes:
        forward: Farthest ahead, in [m].
        backward: Farthest behind, in [m].
        outward: How much farther to the side than the foot spacing, in [m].
        gap: Least distance between soles that stand abreast, in [m].
    """

    forward: float = 0.12
    backward: float = 0.12
    outward: float = 0.12
    gap: float = 0.012


def push_bound(
    plan: ManeuverPlan,
    time: float,
    direction: float,
    mass: float,
    reach: FootReach,
    *,
    lasts: float = 0.0,
    steps: int = 1,
) -> float:
    r"""Largest push that can be held, and every smaller one too.

    It is held by the feet on the floor, or by footsteps within reach that
    land when planned, the first in place of the next that is planned.

    A push that lasts is a constant force, and the ZMP is free from its
    begin: with :math:`h = \eta T` it moves the DCM by the factor
    :math:`(1 - e^{-h}) / h` less than an impulse at its begin would.

    Args:
        plan: Plan being walked.
        time: When the push begins, since the plan began, in [s]; within its
            first step.
        direction: Of the push, from the support foot's heading, in [rad].
        mass: Of the body, in [kg].
        reach: Where a footstep may land.
        lasts: How long the push lasts, in [s]; 0 is an impulse.
        steps: Footsteps that may be made, one by default. After a halt none
            follow.

    Returns:
        Impulse at the CoM, in [N s]; 0 if the DCM cannot be held at all.

    Raises:
        PlanError: If a value is not finite or out of its range.
    """
    check_positive(mass, "mass", "kg")
    check_bearing(direction, "direction")
    check_within(time, 0.0, plan.schedule.first_step_duration, "time", "s")
    check_not_negative(lasts, "lasts", "s")
    check_within(steps, 0, MOST_STEPS, "steps", "1")
    for name, value in reach._asdict().items():
        check_not_negative(value, f"reach.{name}", "m")
    dcm = plan.sample([time]).dcm[0]
    heading = np.array([cos(direction), sin(direction)])
    eta = plan.schedule.settings.eta
    shift = 0.0
    # Every smaller push must be held too, whichever region holds it.
    for enter, leave in sorted(
        ray_interval(dcm, heading, region)
        for region in held_regions(plan, time, reach, steps)
    ):
        if enter <= shift:
            shift = max(shift, leave)
    h = eta * lasts
    spread = h / -expm1(-h) if h > 0.0 else 1.0
    return mass * eta * shift * spread


def held_regions(
    plan: ManeuverPlan, time: float, reach: FootReach, steps: int
) -> list[Array]:
    """DCMs that can be held; each region is convex, their union need not be.

    Args:
        plan: Plan being walked.
        time: Since it began, in [s].
        reach: Where a footstep may land.
        steps: Footsteps that may be made.

    Returns:
        Corners of each region in the plan frame, counter-clockwise, in [m]:
        first of what the feet on the floor hold for good, then of what
        footsteps hold. Shapes (n, 2).
    """
    gait, phases = plan.schedule.settings, plan.support()
    now = max(i for i, phase in enumerate(phases) if phase.start <= time)
    regions = [phases[now].corners]
    until = now if phases[now].single else now + 1
    if not steps or until == len(phases):
        return regions
    row = phases[until].rows[0]
    x, y, theta = plan.placements[row]
    c, s = cos(theta), sin(theta)
    support = plan.first_foot if row % 2 == 0 else plan.first_foot.other
    for region in _caught(gait, reach, support, steps):
        region = region @ np.array([[c, s], [-s, c]]) + (x, y)
        for phase in reversed(phases[now : until + 1]):
            rest = phase.end - max(phase.start, time)
            region = _before(region, phase.corners, gait.eta, rest)
        regions.append(region)
    return regions


def ray_interval(
    start: Array, heading: Array, polygon: Array
) -> tuple[float, float]:
    """Part of a ray that lies inside a convex polygon.

    Args:
        start: Where it begins, in [m]. Shape (2,).
        heading: Unit vector. Shape (2,).
        polygon: Corners, counter-clockwise, in [m]. Shape (n, 2).

    Returns:
        Where it enters and leaves, in [m]; (0, 0) if it misses.
    """
    edges = np.roll(polygon, -1, axis=0) - polygon
    outward = np.column_stack([edges[:, 1], -edges[:, 0]])
    room = ((polygon - start) * outward).sum(axis=1)
    rate = outward @ heading
    enters, leaves, beside = rate < 0.0, rate > 0.0, rate == 0.0
    enter = max(0.0, float((room[enters] / rate[enters]).max()))
    leave = float((room[leaves] / rate[leaves]).min())
    if leave <= enter or np.any(room[beside] < 0.0):
        return 0.0, 0.0
    return enter, leave


def _caught(
    gait: GaitSettings, reach: FootReach, support: Foot, steps: int
) -> list[Array]:
    """DCMs at a landing that this footstep and later ones hold.

    Returns:
        Corners of convex regions in the axes of the foot that stands.
    """
    side = support.other.value
    near = 2.0 * gait.sole.inner + reach.gap
    far = max(gait.foot_spacing + reach.outward, near)
    ahead = (-reach.backward, reach.forward)
    landings = np.array([(x, side * y) for x in ahead for y in (near, far)])
    old = sole_corners(np.zeros(3), support, gait.sole)
    new = sole_corners(np.zeros(3), support.other, gait.sole)
    regions = [convex_hull(np.concatenate([old, _sum(landings, new)]))]
    if steps == 1:
        return regions
    # Or on: hull of both for a double support, then the new foot alone, then
    # the next landing. With the weight w of the new foot in the mean ZMP the
    # region is linear in w, so the union is the hull of its two ends.
    fade = exp(-gait.eta * gait.double_support)
    for later in _caught(gait, reach, support.other, steps - 1):
        alone = _before(later, new, gait.eta, gait.single_support)
        stays = _sum(fade * _sum(landings, alone), (1.0 - fade) * old)
        moves = _sum(landings, _sum(fade * alone, (1.0 - fade) * new))
        regions.append(convex_hull(np.concatenate([stays, moves])))
    return regions


def _before(region: Array, feet: Array, eta: float, duration: float) -> Array:
    """DCMs that a ZMP under the feet can bring into a region in a time."""
    fade = exp(-eta * duration)
    return _sum(fade * region, (1.0 - fade) * feet)


def _sum(a: Array, b: Array) -> Array:
    """Minkowski sum of two convex polygons, one of them with an inside."""
    total: Array = (a[:, None] + b[None]).reshape(-1, 2)
    return convex_hull(total)
