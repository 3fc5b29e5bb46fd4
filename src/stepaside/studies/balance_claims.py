"""Claims of Sec. III-D on the bounded CoM, and on planning time."""

from math import degrees
from time import process_time

import numpy as np

from ..planning import CenterState, Direction, Foot, ManeuverPlan
from ..planning.maneuver import ManeuverPlanner
from .claims import Claim, Readings, most_deviating
from .planner_claims import BEARING, COUNT, GAIT

REST = 4.0  # time after the last step that is evaluated, in [s]
PLANS = 400  # number of timed plans


def read_com() -> Readings:
    """Measure the bounded CoM (15)-(17) of a plan, and its final heading."""
    planner = ManeuverPlanner(GAIT)
    left, right = (
        planner.plan(
            bearing,
            Direction.BACKWARD,
            first_foot=Foot.LEFT,
            standing=True,
            count=COUNT,
        )
        for bearing in (BEARING, -BEARING)
    )
    samples = left.sample(np.arange(0.0, left.schedule.duration + REST, 0.01))
    ends = [
        degrees(float(left.placements[-1, 2])),
        -degrees(float(right.placements[-1, 2])),
    ]
    return {
        "bounded": float(np.hypot(*(samples.com - samples.zmp).T).max()),
        "pendulum": pendulum_error(left),
        "integral": quadrature_error(left),
        "reached": most_deviating(ends, degrees(BEARING)),
    }


def pendulum_error(plan: ManeuverPlan) -> float:
    """Return the largest residual of x'' = eta^2 (x - z), in [m/s^2].

    By finite differences in the middle of each phase of the plan, where the
    CoM is smooth.
    """
    h = 1e-3
    starts = plan.schedule.starts
    middles = 0.5 * (starts[1:] + starts[:-1])
    before, here, after = (
        plan.sample(middles + shift) for shift in (-h, 0.0, h)
    )
    rate = (after.com - 2.0 * here.com + before.com) / h**2
    expected = GAIT.eta**2 * (here.com - here.zmp)
    return float(np.abs(rate - expected).max())


def quadrature_error(plan: ManeuverPlan) -> float:
    """Return the largest difference of the DCM to (16), by midpoint rule."""
    h = 5e-4
    middles = np.arange(0.5 * h, plan.schedule.duration + REST, h)
    zmp = plan.sample(middles).zmp
    worst = 0.0
    for time in (0.0, 1.0, 3.3, 7.1):
        ahead = middles > time
        weight = GAIT.eta * np.exp(-GAIT.eta * (middles[ahead] - time)) * h
        weight /= weight.sum() + np.exp(
            -GAIT.eta * (middles[-1] + 0.5 * h - time)
        )
        integral = weight @ zmp[ahead]
        worst = max(
            worst, float(np.abs(integral - plan.sample([time]).dcm).max())
        )
    return worst


COM = (
    Claim(
        "bounded",
        "the CoM is bounded (its greatest distance from the ZMP, until "
        f"{REST:g} s after the last step)",
        "III-D",
        "planner",
        GAIT.foot_spacing,
        "m",
        relation="<",
    ),
    Claim(
        "pendulum",
        "it moves as the linear inverted pendulum (greatest difference of "
        "x'' to eta^2 (x - x_ZMP))",
        "III-D",
        "planner",
        0.0,
        "m/s^2",
        1e-4,
    ),
    Claim(
        "integral",
        "x_u is the integral (16) (greatest difference to quadrature)",
        "III-D",
        "planner",
        0.0,
        "m",
        1e-6,
    ),
    Claim(
        "reached",
        "desired headings are reached (last footstep of a plan)",
        "III-B",
        "planner",
        degrees(BEARING),
        "deg",
        1e-9,
    ),
)


def read_timing() -> Readings:
    """Measure the processor time of plans of a walking robot, in [ms]."""
    planner = ManeuverPlanner(GAIT)
    state = CenterState((0.0, 0.03), (0.05, -0.1))
    spent = []
    for bearing in np.linspace(-1.5, 1.5, PLANS).tolist():
        start = process_time()
        planner.plan(
            bearing, Direction.FORWARD, first_foot=Foot.LEFT, state=state
        )
        spent.append(process_time() - start)
    return {"planning": 1e3 * float(np.quantile(spent, 0.99))}


TIMING = (
    Claim(
        "planning",
        "planning takes less than 10 ms (99th percentile, on the computer "
        "that made this report, not on a NAO)",
        "IV",
        "planner",
        10.0,
        "ms",
        relation="<",
    ),
)
