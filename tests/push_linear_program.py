"""Largest push by linear programs: sampled ZMP, one landing at a time.

Nothing here uses what the bound is made of: no Minkowski sums, no hulls and
no phases of the package. Corners of soles, times of the gait and a landing
out of a grid go in; every ZMP sample is a weighted mean of corners.
"""

from itertools import product
from math import cos, sin

import numpy as np
from scipy.optimize import linprog

from reference_plans import reference_sole
from stepaside.core.poses import Array
from stepaside.planning import Foot, ManeuverPlan
from stepaside.planning.push_bound import FootReach

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
