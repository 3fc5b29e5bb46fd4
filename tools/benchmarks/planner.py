"""Time the maneuver planner against Drake's ZMP planner for the same ZMP."""

import numpy as np
from call_timing import time_call

from stepaside.core.constants import GRAVITY
from stepaside.core.poses import Pose
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)

BEARING = 0.7  # [rad]


def measure_planner() -> dict[str, float]:
    """Return the times of a replan and of a long sampled plan, in [us]."""
    planner = ManeuverPlanner(GaitSettings())
    state = CenterState((0.0, 0.03), (0.05, -0.1))
    swing = Pose(0.04, 0.1, 0.05)

    def replan() -> ManeuverPlan:
        return planner.plan(
            BEARING,
            Direction.BACKWARD,
            first_foot=Foot.LEFT,
            state=state,
            swing_start=swing,
        )

    def long_plan() -> ManeuverPlan:
        return planner.plan(
            BEARING,
            Direction.BACKWARD,
            first_foot=Foot.LEFT,
            standing=True,
            count=20,
        )

    plan = long_plan()
    times = np.arange(0.0, plan.schedule.duration, 0.01)
    sampler = plan.schedule.sampler(times)
    with_samples = time_call(lambda: long_plan().sample(sampler))
    return {
        "replan_5_steps_us": 1e6 * time_call(replan),
        "plan_20_steps_us": 1e6 * time_call(long_plan),
        "plan_20_steps_with_samples_us": 1e6 * with_samples,
        "samples": float(times.size),
        **_measure_drake(plan),
    }


def _measure_drake(plan: ManeuverPlan) -> dict[str, float]:
    """Time both closed forms for the ZMP of this plan; empty without Drake.

    Ours is the whole plan, from the bearing on; Drake's is the CoM alone. The
    second pair adds samples of CoM and velocity every 10 ms.
    """
    try:
        from pydrake.planning import ZmpPlanner
        from pydrake.polynomial import Polynomial
        from pydrake.trajectories import PiecewisePolynomial
    except ImportError:
        return {}
    schedule = plan.schedule
    coefficients = plan.zmp_coefficients
    pieces = [
        np.array([[Polynomial(coefficients[:, i, axis])] for axis in range(2)])
        for i in range(schedule.durations.size)
    ]
    # Drake expects an end at rest: let the ZMP stay at its last value.
    end = plan.sample([schedule.duration]).zmp[0]
    pieces.append(np.array([[Polynomial(value)] for value in end]))
    knots = [*schedule.starts.tolist(), schedule.duration + 0.1]
    zmp = PiecewisePolynomial(pieces, knots)
    start = plan.sample([0.0])
    state = np.concatenate([start.com[0], start.com_velocity[0]])
    gait = schedule.settings
    weight = 1e-9 * np.eye(2)  # CoM acceleration: track the ZMP
    drake = ZmpPlanner()

    def solve() -> None:
        drake.Plan(zmp, state, gait.com_height, GRAVITY, np.eye(2), weight)

    times = np.arange(0.0, schedule.duration, 0.01)
    nominal = (drake.get_nominal_com, drake.get_nominal_comd)

    def solve_and_sample() -> None:
        solve()
        for value in nominal:
            for time in times:
                value(time)

    drake_us = 1e6 * time_call(solve, calls=20)
    sampled_us = 1e6 * time_call(solve_and_sample, calls=5)
    theirs = np.array([drake.get_nominal_com(t).ravel() for t in times])
    ours = plan.sample(times).com
    return {
        "drake_zmp_planner_us": drake_us,
        "drake_with_samples_us": sampled_us,
        "com_difference_to_drake_m": float(np.abs(theirs - ours).max()),
    }
