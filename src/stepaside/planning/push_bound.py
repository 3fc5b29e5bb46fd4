r"""Largest push from which the linear inverted pendulum can recover.

An impulse J at the CoM shifts the DCM by :math:`J / (m \eta)`. With a ZMP
whose mean, weighted by :math:`e^{-\eta t}`, is p, the DCM after a time T is

.. math:: \xi(T) = e^{\eta T} \xi(0) - (e^{\eta T} - 1)\, p,

so the DCMs that ZMPs in a convex set P can bring into a convex set X are
:math:`e^{-\eta T} X \oplus (1 - e^{-\eta T}) P`, again convex.

A footstep f in a convex set F places a sole B + f beside the stance sole A.
The DCMs that the two feet can then hold indefinitely are their hull, and
the union of these hulls over all f is the hull of A and :math:`F \oplus B`.

The bound holds for a point mass at constant height, a ZMP anywhere in the
support polygon and of any speed, and footsteps that land as planned in time,
parallel to the stance foot. Angular momentum about the CoM, vertical motion
and changed step times are outside of this model.
"""

from math import cos, exp, expm1, sin
from typing import NamedTuple

import numpy as np

from ..core.convex import convex_hull, half_planes
from ..core.errors import check_within
from ..core.poses import Array, Pose
from .gait_settings import GaitSettings
from .maneuver import CenterState, ManeuverPlanner, landing_state
from .path import Direction, Foot
from .plan import ManeuverPlan, sole_corners


class FootReach(NamedTuple):
    """Reachable landings, in the axes of the support foot."""

    forward: float = 0.12  # largest distance ahead [m]
    backward: float = 0.12  # largest distance behind [m]
    # largest lateral distance beyond the foot spacing [m]
    outward: float = 0.12
    gap: float = 0.012  # least distance between soles abreast [m]


def push_bound(
    plan: ManeuverPlan,
    time: float,
    direction: float,
    mass: float,
    reach: FootReach,
    *,
    lasts: float = 0.0,
) -> float:
    r"""Return the largest impulse J [N s] such that all up to it are held.

    A push is held by the feet on the floor, or by one reachable footstep that
    lands at the planned time, in place of the next planned one. The push
    begins at a time since the plan began, within its first step, in [s], in a
    direction relative to the support foot's heading, in [rad]. If it lasts,
    in [s], it is a constant force, with the ZMP free from its start: with
    :math:`h = \eta T` it shifts the DCM by the factor
    :math:`(1 - e^{-h}) / h` less than an impulse at its start.
    """
    check_within(time, 0.0, plan.schedule.first_step_duration, "time", "s")
    dcm = plan.sample([time]).dcm[0]
    heading = np.array([cos(direction), sin(direction)])
    eta = plan.schedule.settings.eta
    shift = 0.0
    # Every smaller push must be held too, by any of the regions.
    for enter, leave in sorted(
        ray_interval(dcm, heading, region)
        for region in held_regions(plan, time, reach)
    ):
        if enter <= shift:
            shift = max(shift, leave)
    h = eta * lasts
    spread = h / -expm1(-h) if h > 0.0 else 1.0
    return mass * eta * shift * spread


def held_regions(
    plan: ManeuverPlan, time: float, reach: FootReach
) -> list[Array]:
    """Return convex regions of DCMs that can be held, in [m].

    By the feet on the floor, then by the next footstep: counter-clockwise
    corners in the plan frame. Shapes (n, 2).
    """
    gait, phases = plan.schedule.settings, plan.support()
    now = max(i for i, phase in enumerate(phases) if phase.start <= time)
    regions = [phases[now].corners]
    until = now if phases[now].single else now + 1
    if until == len(phases):
        return regions
    row = phases[until].rows[0]
    support = plan.first_foot if row % 2 == 0 else plan.first_foot.other
    region = _held_after_landing(gait, reach, support)
    region = Pose(*plan.placements[row].tolist()).transform_points(region)
    for phase in reversed(phases[now : until + 1]):
        rest = phase.end - max(phase.start, time)
        # DCMs that a ZMP under the feet brings into the region.
        fade = exp(-gait.eta * rest)
        region = _sum(fade * region, (1.0 - fade) * phase.corners)
    regions.append(region)
    return regions


def ray_interval(
    start: Array, heading: Array, polygon: Array
) -> tuple[float, float]:
    """Return where a ray enters and leaves a convex polygon, in [m].

    Corners are counter-clockwise. It is (0, 0) if the ray misses.
    """
    outward, offsets = half_planes(polygon)
    room, rate = offsets - outward @ start, outward @ heading
    enters, leaves, beside = rate < 0.0, rate > 0.0, rate == 0.0
    enter = max(0.0, float((room[enters] / rate[enters]).max()))
    leave = float((room[leaves] / rate[leaves]).min())
    if leave <= enter or np.any(room[beside] < 0.0):
        return 0.0, 0.0
    return enter, leave


def _held_after_landing(
    gait: GaitSettings, reach: FootReach, support: Foot
) -> Array:
    """Return DCMs at a landing that its feet can hold, in the stance foot."""
    side = support.other.value
    near = 2.0 * gait.sole.inner + reach.gap
    far = max(gait.foot_spacing + reach.outward, near)
    ahead = (-reach.backward, reach.forward)
    landings = np.array([(x, side * y) for x in ahead for y in (near, far)])
    old = sole_corners(np.zeros(3), support, gait.sole)
    new = sole_corners(np.zeros(3), support.other, gait.sole)
    return convex_hull(np.concatenate([old, _sum(landings, new)]))


def _sum(a: Array, b: Array) -> Array:
    """Return the Minkowski sum of two polygons, one of positive area."""
    total: Array = (a[:, None] + b[None]).reshape(-1, 2)
    return convex_hull(total)


def steady_plan(
    planner: ManeuverPlanner,
    bearing: float,
    direction: Direction,
    *,
    first_foot: Foot,
) -> ManeuverPlan:
    """Return the plan of a steady walk with a constant bearing.

    The map from one landing to the next is affine; its periodic state is the
    fixed point of two steps. The bearing is in the frame of each foot.
    """

    def plan_from(
        state: np.ndarray, foot: Foot, swing_start: Pose | None = None
    ) -> ManeuverPlan:
        x, y, u, v = state.tolist()
        return planner.plan(
            bearing,
            direction,
            first_foot=foot,
            state=CenterState((x, y), (u, v)),
            swing_start=swing_start,
        )

    def recur(state: np.ndarray) -> np.ndarray:
        for foot in (first_foot, first_foot.other):
            state = np.ravel(landing_state(plan_from(state, foot)))
        return state

    origin, unit = recur(np.zeros(4)), np.eye(4)
    columns = [recur(each) - origin for each in unit]
    state = np.linalg.solve(unit - np.column_stack(columns), origin)
    before = plan_from(state, first_foot.other)
    left_behind = Pose(*before.placements[2].tolist()).inverse()
    return plan_from(state, first_foot, left_behind)
