"""Test the largest push that a step can take."""

from dataclasses import replace
from math import cos, exp, inf, nan, pi, sin

import numpy as np
import pytest
from scipy.optimize import linprog

from stepaside.errors import PlanError
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.capture import Reach, push_bound

MASS = 5.305  # [kg], of the NAO
REACH = Reach()
OUTWARD = {Foot.LEFT: -pi / 2.0, Foot.RIGHT: pi / 2.0}


def walking(
    first_foot: Foot = Foot.LEFT,
    bearing: float = 0.0,
    gait: GaitSettings | None = None,
) -> ManeuverPlan:
    """Plan of a walk under way: the second one after the start."""
    planner = ManeuverPlanner(gait or GaitSettings())
    other = first_foot.other
    start = planner.plan(
        bearing, Direction.FORWARD, first_foot=other, standing=True
    )
    for foot in (first_foot, other, first_foot):
        end = start.sample([start.schedule.first_step_duration])
        x, y, theta = start.placements[2]
        turn = np.array([[cos(theta), -sin(theta)], [sin(theta), cos(theta)]])
        position = (end.com[0] - (x, y)) @ turn
        velocity = end.com_velocity[0] @ turn
        start = planner.plan(
            bearing,
            Direction.FORWARD,
            first_foot=foot,
            state=CenterState(tuple(position), tuple(velocity)),
        )
    return start


def test_outward_bound_is_what_the_sole_alone_holds() -> None:
    plan = walking()
    gait = plan.schedule.settings
    dcm = plan.sample([0.0]).dcm[0]
    by_hand = MASS * gait.eta * (gait.sole.outer + dcm[1])
    bound = push_bound(plan, 0.0, OUTWARD[Foot.LEFT], MASS, REACH)
    assert bound == pytest.approx(by_hand, rel=1e-9)
    assert bound == pytest.approx(1.4, abs=0.15)


@pytest.mark.parametrize("time", [0.0, 0.2, 0.42, 0.45, 0.54])
@pytest.mark.parametrize("direction", np.linspace(-3.0, 3.0, 5).tolist())
def test_bound_grows_with_the_sole_and_the_reach(
    time: float, direction: float
) -> None:
    plan = walking(bearing=0.5)
    gait = plan.schedule.settings
    sole = replace(gait.sole, back=-0.06, front=0.105, outer=0.052)
    larger = walking(bearing=0.5, gait=replace(gait, sole=sole))
    bound = push_bound(plan, time, direction, MASS, REACH)
    assert push_bound(larger, time, direction, MASS, REACH) > bound
    wide = Reach(0.2, 0.2, 0.2, 0.0)
    assert push_bound(plan, time, direction, MASS, wide) >= bound


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


@pytest.mark.parametrize("time", [0.0, 0.15, 0.4])
@pytest.mark.parametrize("direction", [0.0, pi / 2.0, pi, 0.8])
def test_one_step_bound_is_the_optimum_of_a_linear_program(
    time: float, direction: float
) -> None:
    """Discretise both supports finely, with a ZMP free in each sample."""
    plan = walking()
    gait, n = plan.schedule.settings, 400
    eta, sole = gait.eta, gait.sole
    rest = gait.single_support - time
    end = rest + gait.double_support
    grid = np.linspace(0.0, end, n + 1)
    weights = np.exp(-eta * grid[:-1]) - np.exp(-eta * grid[1:])
    ramp = np.clip((0.5 * (grid[1:] + grid[:-1]) - rest) / (end - rest), 0, 1)
    dcm = plan.sample([time]).dcm[0]
    # Unknowns: J, foot (2), end DCM in it (2), offsets (n, 2) in the soles.
    size, rows, right = 5 + 2 * n, [], []
    heading = (cos(direction), sin(direction))
    low = np.zeros(size)
    high = np.full(size, inf)
    near, far = 2.0 * sole.inner + REACH.gap, gait.foot_spacing + REACH.outward
    low[1], high[1] = -REACH.backward, REACH.forward
    low[2], high[2] = near, far
    low[3], high[3] = sole.back, sole.front
    low[4], high[4] = -sole.inner, sole.outer
    for axis in range(2):
        row = np.zeros(size)
        row[0] = heading[axis] / (MASS * eta)
        row[1 + axis] = -(exp(-eta * end) + weights @ ramp)
        row[3 + axis] = -exp(-eta * end)
        row[5 + axis :: 2] = -weights
        rows.append(row)
        right.append(-dcm[axis])
    low[5::2], high[5::2] = sole.back, sole.front
    low[6::2] = -(1.0 - ramp) * sole.outer - ramp * sole.inner
    high[6::2] = (1.0 - ramp) * sole.inner + ramp * sole.outer
    cost = np.zeros(size)
    cost[0] = -1.0
    result = linprog(
        cost,
        A_eq=np.array(rows),
        b_eq=right,
        bounds=list(zip(low, high, strict=True)),
    )
    bound = push_bound(plan, time, direction, MASS, REACH)
    assert bound == pytest.approx(result.x[0], rel=2e-3)


def test_a_push_later_in_the_step_may_be_harder_forward() -> None:
    plan = walking()
    bounds = [push_bound(plan, t, 0.0, MASS, REACH) for t in (0.0, 0.2, 0.4)]
    assert bounds == sorted(bounds)


@pytest.mark.parametrize(
    "time, direction, mass",
    [(-0.1, 0, 5), (nan, 0, 5), (0, nan, 5), (0, 0, 0)],
)
def test_refuses_what_is_no_push(
    time: float, direction: float, mass: float
) -> None:
    with pytest.raises(PlanError):
        push_bound(walking(), time, direction, mass, REACH)
