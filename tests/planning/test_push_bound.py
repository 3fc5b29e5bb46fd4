"""Test the push bound of the pendulum, against linear programs too."""

from itertools import product
from math import cos, exp, pi, sin

import numpy as np
import pytest
from scipy.optimize import linprog

from reference_plans import plan_of, reference_sole
from stepaside.core.convex import half_planes
from stepaside.core.poses import Array
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.push_bound import (
    FootReach,
    held_regions,
    push_bound,
    steady_plan,
)

SAMPLES = 8  # in each phase


STANDS = 1.5  # how long the ZMP is sampled after the last landing, in [s]


FINE = 2000  # parts of a push that lasts


Supports = list[tuple[float, Array]]  # (how long, corners), one by one


def corners_of(plan: ManeuverPlan, *rows: int) -> Array:
    """Corners of some soles where the plan has them."""
    return np.concatenate([reference_sole(plan, row) for row in rows])


def landing(plan: ManeuverPlan, row: int, x: float, y: float) -> Array:
    """Corners of the foot that swings over a row, landed beside it."""
    sole = plan.schedule.settings.sole
    swings_left = (plan.first_foot is Foot.LEFT) == (row % 2 == 1)
    low, high = -sole.inner, sole.outer
    if not swings_left:
        y, low, high = -y, -high, -low
    px, py, theta = plan.placements[row].tolist()
    c, s = cos(theta), sin(theta)
    points = [
        (x + u, y + v) for u in (sole.back, sole.front) for v in (low, high)
    ]
    return np.array(
        [(px + c * u - s * v, py + s * u + c * v) for u, v in points]
    )


def landings(plan: ManeuverPlan, reach: FootReach, number: int) -> list[Array]:
    """Grid of landings in the axes of the support foot, as for a left one."""
    gait = plan.schedule.settings
    near = 2.0 * gait.sole.inner + reach.gap
    far = max(gait.foot_spacing + reach.outward, near)
    ahead = np.linspace(-reach.backward, reach.forward, number)
    return [
        np.array(f) for f in product(ahead, np.linspace(near, far, number))
    ]


def options(
    plan: ManeuverPlan, time: float, reach: FootReach, number: int
) -> list[Supports]:
    """Everything the feet can do: stay, or one footstep of the grid."""
    gait = plan.schedule.settings
    walked = time - (gait.start_support if plan.schedule.standing else 0.0)
    single, double = gait.single_support, gait.double_support
    before: Supports
    if walked < 0.0:
        row, feet = 1, corners_of(plan, 0, 1)
        before = [(-walked, feet), (single, corners_of(plan, 1))]
    elif walked < single:
        row, feet = 1, corners_of(plan, 1)
        before = [(single - walked, feet)]
    else:
        row, feet = 2, corners_of(plan, 1, 2)
        rest = single + double - walked
        before = [(rest, feet), (single, corners_of(plan, 2))]
    steps: list[Supports] = [[(STANDS, feet)]]
    for x, y in landings(plan, reach, number):
        both = np.concatenate(
            [corners_of(plan, row), landing(plan, row, x, y)]
        )
        steps.append([*before, (STANDS, both)])
    return steps


def interval(
    plan: ManeuverPlan,
    time: float,
    direction: float,
    mass: float,
    supports: Supports,
    lasts: float,
) -> tuple[float, float] | None:
    """Least and largest impulse that one way to set the feet holds."""
    eta = plan.schedule.settings.eta
    columns, begin = [], 0.0
    for duration, corners in supports:
        edges = begin + np.linspace(0.0, duration, SAMPLES + 1)
        for one, two in zip(edges, edges[1:], strict=False):
            weight = np.exp(-eta * one) - np.exp(-eta * two)
            columns.append((weight, corners))
        begin += duration
    columns.append((float(np.exp(-eta * begin)), supports[-1][1]))
    # The force over the push, each part seen from the begin.
    middles = lasts * (np.arange(FINE) + 0.5) / FINE
    push = float(np.exp(-eta * middles).mean()) / (mass * eta)
    size = 1 + sum(len(corners) for _, corners in columns)
    rows = np.zeros((2 + len(columns), size))
    right = np.ones(2 + len(columns))
    rows[:2, 0] = -push * np.array([cos(direction), sin(direction)])
    right[:2] = plan.sample([time]).dcm[0]
    at = 1
    for i, (weight, corners) in enumerate(columns):
        rows[:2, at : at + len(corners)] = weight * corners.T
        rows[2 + i, at : at + len(corners)] = 1.0
        at += len(corners)
    cost = np.zeros(size)
    found = []
    for sign in (1.0, -1.0):
        cost[0] = sign
        answer = linprog(cost, A_eq=rows, b_eq=right, bounds=(0.0, None))
        if answer.status != 0:
            return None
        found.append(float(answer.x[0]))
    return found[0], found[1]


def brute_force(
    plan: ManeuverPlan,
    time: float,
    direction: float,
    mass: float,
    reach: FootReach,
    *,
    lasts: float = 0.0,
    number: int = 5,
) -> float:
    """Largest impulse that some landing holds, with all smaller ones."""
    largest = 0.0
    held = [
        interval(plan, time, direction, mass, supports, lasts)
        for supports in options(plan, time, reach, number)
    ]
    for low, high in sorted(pair for pair in held if pair is not None):
        if low <= largest + 1e-6:
            largest = max(largest, high)
    return largest


MASS = 5.305  # [kg], of the NAO


GAIT = GaitSettings()


REACH = FootReach()


SHORT = FootReach(0.08, 0.08, 0.02, 0.012)  # of the feedback


OUTWARD = {Foot.LEFT: -pi / 2.0, Foot.RIGHT: pi / 2.0}


def walking(
    first_foot: Foot = Foot.LEFT,
    bearing: float = 0.0,
    gait: GaitSettings | None = None,
) -> ManeuverPlan:
    """Plan of a walk under way."""
    return steady_plan(
        ManeuverPlanner(gait or GAIT),
        bearing,
        Direction.FORWARD,
        first_foot=first_foot,
    )


def test_the_outward_bound_is_that_of_the_sole() -> None:
    plan = walking()
    dcm = plan.sample([0.0]).dcm[0]
    expected = MASS * GAIT.eta * (GAIT.sole.outer + dcm[1])
    bound = push_bound(plan, 0.0, OUTWARD[Foot.LEFT], MASS, REACH)
    assert bound == pytest.approx(expected, rel=1e-9)


def test_inward_bound_is_the_farthest_foot_and_the_inner_edge_until_then() -> (
    None
):
    """At the landing the whole weight can be on the far edge of the foot."""
    plan, time = walking(), 0.4
    rest = GAIT.single_support - time
    fade = exp(-GAIT.eta * rest)
    far = GAIT.foot_spacing + REACH.outward + GAIT.sole.outer
    held = fade * far + (1.0 - fade) * GAIT.sole.inner
    dcm = plan.sample([time]).dcm[0]
    expected = MASS * GAIT.eta * (held - dcm[1])
    bound = push_bound(plan, time, pi / 2.0, MASS, REACH)
    assert bound == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("time", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("direction", [0.0, 1.0, 2.5, -2.0])
def test_bound_is_the_same_in_the_mirror(
    time: float, direction: float
) -> None:
    left = push_bound(walking(Foot.LEFT, 0.4), time, direction, MASS, REACH)
    right = push_bound(
        walking(Foot.RIGHT, -0.4), time, -direction, MASS, REACH
    )
    assert left == pytest.approx(right, rel=1e-9)
    assert left > 0.0


def test_a_push_that_lasts_is_an_impulse_and_a_factor() -> None:
    """(1 - e^-h) / h of it counts, for the DCM grows meanwhile."""
    plan = walking()
    one = push_bound(plan, 0.1, 0.3, MASS, REACH)
    h = GAIT.eta * 0.1
    lasting = push_bound(plan, 0.1, 0.3, MASS, REACH, lasts=0.1)
    assert lasting == pytest.approx(one * h / (1.0 - exp(-h)), rel=1e-12)
    short = push_bound(plan, 0.1, 0.3, MASS, REACH, lasts=1e-9)
    assert short == pytest.approx(one, rel=1e-6)


def test_a_lost_state_has_a_zero_bound_in_the_recovering_direction() -> None:
    """Every smaller push has to be held, too."""
    plan = ManeuverPlanner(GAIT).plan(
        0.0,
        Direction.FORWARD,
        first_foot=Foot.LEFT,
        state=CenterState((0.0, -0.2), (0.0, 0.0)),
    )
    assert push_bound(plan, 0.0, pi / 2.0, MASS, REACH) == 0.0


def test_a_halt_is_held_by_its_two_feet_and_no_third_step() -> None:
    plan = plan_of("halt")
    landed = GAIT.single_support + 0.05
    [region] = held_regions(plan, landed, REACH)
    normals, offsets = half_planes(region)
    room = offsets - corners_of(plan, 1, 2) @ normals.T
    assert room.min() > -1e-12
    assert len(held_regions(plan, 0.1, REACH)) == 2


@pytest.mark.parametrize(
    ("kind", "time", "direction", "reach", "lasts"),
    [
        ("walk", 0.0, 0.0, SHORT, 0.0),
        ("walk", 0.05, pi, SHORT, 0.0),
        ("walk", 0.4, pi / 2.0, REACH, 0.0),  # inward
        ("walk", 0.2, -1.0, REACH, 0.1),
        ("walk", 0.41, 2.2, REACH, 0.1),  # the push lasts past the landing
        ("walk", 0.47, 0.4, SHORT, 0.1),
        ("walk", 0.52, -2.0, SHORT, 0.0),
        ("start", 0.3, 0.0, REACH, 0.0),
        ("start", 0.7, 1.2, SHORT, 0.1),
    ],
)
def test_bound_is_the_best_of_all_linear_programs(
    kind: str, time: float, direction: float, reach: FootReach, lasts: float
) -> None:
    """Sampled ZMPs, and one landing at a time."""
    plan = walking(bearing=0.3) if kind == "walk" else plan_of(kind)
    bound = push_bound(plan, time, direction, MASS, reach, lasts=lasts)
    brute = brute_force(
        plan, time, direction, MASS, reach, lasts=lasts, number=3
    )
    assert bound == pytest.approx(brute, rel=1e-6)
