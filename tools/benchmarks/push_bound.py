"""Compare the push bound with brute force, at 60 phases and directions.

The linear programs are those of ``tests/push_linear_program.py``.
"""

import sys
from dataclasses import replace
from math import tau
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from push_linear_program import brute_force
from stepaside.planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.capturability import FootReach, push_bound
from stepaside.planning.steady_gait import steady_plan

MASS = 5.3  # mass, in [kg]
CASES = 60
REACHES = (FootReach(), FootReach(0.08, 0.08, 0.02, 0.012))


def case(
    generator: np.random.Generator,
) -> tuple[ManeuverPlan, float, float, FootReach, float]:
    """Return a plan with time, direction, reach and duration of a push."""
    gait = replace(
        GaitSettings(), zmp_profile=("linear", "cubic")[generator.integers(2)]
    )
    planner = ManeuverPlanner(gait)
    foot = (Foot.LEFT, Foot.RIGHT)[generator.integers(2)]
    bearing = generator.uniform(-1.5, 1.5)
    if generator.integers(5) == 0:
        plan = planner.plan(
            bearing, Direction.FORWARD, first_foot=foot, standing=True
        )
    else:
        plan = steady_plan(
            planner, bearing, Direction.FORWARD, first_foot=foot
        )
    return (
        plan,
        generator.uniform(0.0, plan.schedule.first_step_duration),
        generator.uniform(0.0, tau),
        REACHES[generator.integers(2)],
        (0.0, 0.1)[generator.integers(2)],
    )


def compare() -> float:
    """Return the largest relative difference; print each case."""
    generator, worst = np.random.default_rng(0), 0.0
    print("  time [s]  direction  lasts   bound  brute force [N s]")
    for _ in range(CASES):
        plan, time, direction, reach, lasts = case(generator)
        bound = push_bound(plan, time, direction, MASS, reach, lasts=lasts)
        brute = brute_force(plan, time, direction, MASS, reach, lasts=lasts)
        worst = max(worst, abs(bound - brute) / max(brute, 1e-3))
        print(
            f"{time:10.3f}  {direction:9.2f}  {lasts:5.1f}  "
            f"{bound:6.3f}  {brute:6.3f}"
        )
    return worst


if __name__ == "__main__":
    print(f"largest difference: {100.0 * compare():.2g} %")
