"""Test plans as values."""

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.core.poses import Pose
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)

GAIT = GaitSettings()
PLANNER = ManeuverPlanner(GAIT)
STATE = CenterState((0.01, 0.03), (0.05, -0.1))
START = Pose(-0.03, 0.11, 0.1)


def walking(
    foot: Foot = Foot.LEFT, state: CenterState = STATE
) -> ManeuverPlan:
    return PLANNER.plan(
        0.5, Direction.FORWARD, first_foot=foot, state=state, swing_start=START
    )


def test_a_plan_begins_where_the_body_is() -> None:
    plan = walking()
    begin = plan.sample([0.0])
    np.testing.assert_allclose(begin.com[0], STATE.position, atol=1e-12)
    np.testing.assert_allclose(begin.com_velocity[0], STATE.velocity)
    np.testing.assert_allclose(plan.start_velocity, STATE.velocity)
    np.testing.assert_allclose(begin.left_foot[0], START)
    np.testing.assert_allclose(begin.right_foot[0], 0.0)
    np.testing.assert_allclose(begin.zmp[0], [GAIT.zmp_forward, 0.0])


def test_from_standing_it_begins_at_rest_midway_between_the_feet() -> None:
    for foot, side in ((Foot.LEFT, 1.0), (Foot.RIGHT, -1.0)):
        plan = PLANNER.plan(
            0.5, Direction.BACKWARD, first_foot=foot, standing=True
        )
        begin = plan.sample([0.0])
        middle = [GAIT.zmp_forward, 0.5 * side * GAIT.foot_spacing]
        np.testing.assert_allclose(begin.com[0], middle, atol=1e-12)
        np.testing.assert_allclose(begin.zmp[0], middle, atol=1e-12)
        np.testing.assert_allclose(begin.com_velocity[0], 0.0, atol=1e-12)


def test_zmp_stands_in_the_anchor_of_each_support_foot() -> None:
    """Ahead of the foot frame, along the foot's own heading."""
    plan = walking()
    middles = np.arange(5) * GAIT.step_duration + 0.5 * GAIT.single_support
    zmp = plan.sample(middles[1:]).zmp
    x, y, theta = plan.placements[2:6].T
    ahead = GAIT.zmp_forward
    np.testing.assert_allclose(zmp[:, 0], x + ahead * np.cos(theta))
    np.testing.assert_allclose(zmp[:, 1], y + ahead * np.sin(theta))


def test_the_correction_absorbs_a_velocity_error() -> None:
    """No correction if the velocity is that of (16); else it is linear."""
    plan = walking()
    row = plan.schedule.dcm_start_map
    free = plan.inputs.copy()
    free[-2] = 0.0
    wanted = GAIT.eta * (row @ free - free[-1])
    calm = walking(state=CenterState(STATE.position, tuple(wanted.tolist())))
    np.testing.assert_allclose(calm.correction, 0.0, atol=1e-12)
    off = (np.array(STATE.velocity) - wanted) / GAIT.eta
    np.testing.assert_allclose(plan.correction * row[-2], off, atol=1e-12)
    assert np.abs(plan.correction).max() > 1e-4


@pytest.mark.parametrize("place", [(np.nan, 0.0), (0.0, np.inf)])
def test_a_state_that_is_no_number_is_refused(
    place: tuple[float, float],
) -> None:
    for name, state in (
        ("CoM position", CenterState(place, (0.0, 0.0))),
        ("CoM velocity", CenterState((0.0, 0.0), place)),
    ):
        with pytest.raises(PlanError, match=f"{name} must be finite"):
            PLANNER.plan(
                0.1, Direction.FORWARD, first_foot=Foot.LEFT, state=state
            )


def test_a_saturated_template_turns_at_full_rate() -> None:
    """Eq. (6): k sign(theta*) instead of k theta*, eq. (8)."""
    turns = {}
    for saturated in (False, True):
        plan = PLANNER.plan(
            0.5,
            Direction.FORWARD,
            first_foot=Foot.LEFT,
            standing=True,
            drive=TemplateDrive(saturated),
        )
        turns[saturated] = plan.placements[2, 2]
    interval = GAIT.path_interval
    assert turns[False] == pytest.approx(0.2 * 0.5 * interval)
    assert turns[True] == pytest.approx(0.2 * interval)
    usual = PLANNER.plan(
        0.5, Direction.FORWARD, first_foot=Foot.LEFT, standing=True
    )
    assert usual.placements[2, 2] == turns[False]


@pytest.mark.parametrize("foot", Foot)
@pytest.mark.parametrize("hurry", [-0.06, 0.06])
def test_margin_in_single_support_is_that_of_the_sole_that_stands(
    foot: Foot, hurry: float
) -> None:
    """Sampled densely: outside and inside of a sole are not alike."""
    aside = foot.value * (hurry - 0.15)
    state = CenterState((0.01, 0.03 * foot.value), (0.05, aside))
    plan = walking(foot, state)
    until = GAIT.single_support
    x, y = plan.sample(np.linspace(0.0, until, 1001)).zmp.T
    sole, side = GAIT.sole, -foot.value  # outward of the foot that stands
    edges = [
        x - sole.back,
        sole.front - x,
        sole.outer - side * y,
        sole.inner + side * y,
    ]
    expected = np.min(edges)
    assert plan.margin(until) == pytest.approx(expected, abs=1e-4)
    assert 0.01 < np.abs(plan.correction[1]) < 0.04


@pytest.mark.parametrize("standing", [False, True])
def test_a_schedule_lasts_as_long_as_its_steps(standing: bool) -> None:
    schedule = PLANNER.schedule(3, standing=standing)
    first = GAIT.start_support if standing else 0.0
    lasts = 3 * GAIT.step_duration + first
    assert schedule.duration == pytest.approx(lasts)
    assert schedule.first_step_duration == GAIT.step_duration + first
