r"""How hard a push the linear inverted pendulum can take in a step.

An impulse J at the CoM moves the DCM by :math:`J / (m \eta)`. A ZMP whose
mean, weighted by :math:`e^{-\eta t}`, is p takes the DCM over a time T to

.. math:: \xi(T) = e^{\eta T} \xi(0) - (e^{\eta T} - 1)\, p,

so the DCMs that can be brought into a convex set X by ZMPs out of a convex
set P are :math:`e^{-\eta T} X \oplus (1 - e^{-\eta T}) P`, again convex.
"""

from math import cos, exp, sin
from typing import NamedTuple

import numpy as np

from ..errors import (
    check_finite,
    check_not_negative,
    check_positive,
    check_within,
)
from ..poses import Array
from .footsteps import Foot
from .plan import ManeuverPlan
from .support import convex_hull, sole_corners


class Reach(NamedTuple):
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
    reach: Reach,
) -> float:
    """Largest impulse after which the DCM can still be held.

    It can be held where it is, by the feet on the floor, or by the footstep
    after it, which lands when planned, parallel to its support foot, within
    reach and without crossing. In double support the sole in which the ZMP
    may be moves from foot to foot.

    Args:
        plan: Plan being walked.
        time: When the push comes, since the plan began, in [s]; within its
            first step.
        direction: Of the push, from the support foot's heading, in [rad].
        mass: Of the body, in [kg].
        reach: Where a footstep may land.

    Returns:
        Impulse at the CoM, in [N s]; 0 if the DCM cannot be held at all.

    Raises:
        PlanError: If a value is not finite or out of its range.
    """
    check_positive(mass, "mass", "kg")
    check_finite(direction, "direction", "rad")
    check_within(time, 0.0, plan.schedule.first_step_duration, "time", "s")
    for name, value in reach._asdict().items():
        check_not_negative(value, f"reach.{name}", "m")
    dcm = plan.sample([time]).dcm[0]
    heading = np.array([cos(direction), sin(direction)])
    regions = (
        held_without_step(plan, time),
        held_with_step(plan, time, reach),
    )
    shift = 0.0
    # Every smaller push must be held too, whichever region holds it.
    for enter, leave in sorted(
        ray_interval(dcm, heading, region) for region in regions
    ):
        if enter <= shift:
            shift = max(shift, leave)
    return mass * plan.schedule.settings.eta * shift


def held_without_step(plan: ManeuverPlan, time: float) -> Array:
    """DCMs that the feet on the floor hold for good.

    Args:
        plan: Plan being walked.
        time: Since it began, in [s].

    Returns:
        Corners in the plan frame, counter-clockwise, in [m]. Shape (n, 2).
    """
    starting, landing, _ = _phases(plan)
    rows = (1,) if starting <= time < landing else (1, 2)
    if time < starting:
        rows = (0, 1)
    return convex_hull(np.concatenate([_sole(plan, row) for row in rows]))


def held_with_step(plan: ManeuverPlan, time: float, reach: Reach) -> Array:
    """DCMs that the next footstep can catch.

    Args:
        plan: Plan being walked.
        time: Since it began, in [s].
        reach: Where that footstep may land.

    Returns:
        Corners in the plan frame, counter-clockwise, in [m]. Shape (n, 2).
    """
    gait = plan.schedule.settings
    starting, landing, end = _phases(plan)
    row = 1 if time < landing else 2
    lasts = gait.single_support
    if starting <= time < landing:
        lasts = landing - time
    stance, region = _sole(plan, row), _caught(plan, row, reach)
    region = _before(region, [(1.0, stance)], gait.eta, lasts)
    if time < starting:
        feet = convex_hull(np.concatenate([_sole(plan, 0), stance]))
        region = _before(region, [(1.0, feet)], gait.eta, starting - time)
    elif time >= landing:
        rest = max(end - time, 0.0)
        done = min(1.0 - rest / gait.double_support, 1.0)
        later = done + (1.0 - done) * _lateness(gait.eta * rest)
        soles = [(1.0 - later, _sole(plan, 1)), (later, stance)]
        region = _before(region, soles, gait.eta, rest)
    return region


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


def _phases(plan: ManeuverPlan) -> tuple[float, float, float]:
    """When the first single support begins, it ends, and its step ends."""
    gait = plan.schedule.settings
    starting = gait.start_support if plan.schedule.standing else 0.0
    landing = starting + gait.single_support
    return starting, landing, landing + gait.double_support


def _side(plan: ManeuverPlan, row: int) -> Foot:
    """Side of a row of the placements."""
    return plan.first_foot if row % 2 == 0 else plan.first_foot.other


def _sole(plan: ManeuverPlan, row: int) -> Array:
    """Corners of a sole where the plan has it. Shape (4, 2)."""
    sole = plan.schedule.settings.sole
    return sole_corners(plan.placements[row], _side(plan, row), sole)


def _caught(plan: ManeuverPlan, row: int, reach: Reach) -> Array:
    """DCMs at a landing that can be brought into the new sole.

    With the weight w of the new foot f in the mean ZMP, and points a, b and
    c of the old sole, of the new one, and of the new one at the end, it is
    e^(-h) (f + c) + (1 - e^(-h)) ((1 - w) a + w (f + b)), h = eta D.
    """
    gait = plan.schedule.settings
    support, swing = _side(plan, row), _side(plan, row + 1)
    here = np.zeros(3)
    near = 2.0 * gait.sole.inner + reach.gap
    far = max(gait.foot_spacing + reach.outward, near)
    landings = np.array(
        [
            (x, swing.value * y)
            for x in (-reach.backward, reach.forward)
            for y in (near, far)
        ]
    )
    old = sole_corners(here, support, gait.sole)
    new = sole_corners(here, swing, gait.sole)
    h = gait.eta * gait.double_support
    fade, later = exp(-h), _lateness(h)
    share = fade + (1.0 - fade) * later
    region = _sum(share * landings, share * new)
    region = _sum(region, (1.0 - share) * old)
    x, y, theta = plan.placements[row]
    c, s = cos(theta), sin(theta)
    turned: Array = region @ np.array([[c, s], [-s, c]]) + (x, y)
    return turned


def _lateness(h: float) -> float:
    """Mean of a ramp from 0 to 1 over [0, h], weighted by e^(-t)."""
    if h < 1e-6:  # both sums below vanish
        return 0.5 - h / 12.0
    return 1.0 / h - exp(-h) / (1.0 - exp(-h))


def _before(
    region: Array,
    soles: list[tuple[float, Array]],
    eta: float,
    duration: float,
) -> Array:
    """DCMs that weighted soles can bring into a region in a time."""
    fade = exp(-eta * duration)
    region = fade * region
    for weight, sole in soles:
        region = _sum(region, (1.0 - fade) * weight * sole)
    return convex_hull(region)


def _sum(a: Array, b: Array) -> Array:
    """Minkowski sum of two convex polygons given by corners."""
    total: Array = (a[:, None] + b[None]).reshape(-1, 2)
    return convex_hull(total) if np.ptp(total, axis=0).all() else total
