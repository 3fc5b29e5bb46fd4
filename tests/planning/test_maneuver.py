"""Test whole maneuvers: pendulum, continuity, symmetry, swing, support."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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

PLANNER = ManeuverPlanner(GaitSettings())
BEARINGS = st.floats(-3.14, 3.14)


def start(
    bearing: float,
    foot: Foot = Foot.LEFT,
    direction: Direction = Direction.BACKWARD,
    planner: ManeuverPlanner = PLANNER,
    count: int = 20,
) -> ManeuverPlan:
    return planner.plan(
        bearing, direction, first_foot=foot, standing=True, count=count
    )


def follow(plan: ManeuverPlan, bearing: float) -> ManeuverPlan:
    """Replan at the end of the first step, in the new support foot frame."""
    end = plan.sample([plan.schedule.first_step_duration])
    step = Pose(*plan.placements[2])
    back = step.inverse()
    com, velocity = end.com[0].tolist(), end.com_velocity[0].tolist()
    x, y, _ = back.compose(Pose(com[0], com[1], 0.0))
    vx, vy, _ = Pose(0.0, 0.0, back.theta).compose(
        Pose(velocity[0], velocity[1], 0.0)
    )
    return PLANNER.plan(
        bearing,
        plan.direction,
        first_foot=plan.first_foot.other,
        state=CenterState((x, y), (vx, vy)),
        swing_start=back.compose(Pose(*plan.placements[1])),
    )


@settings(max_examples=25, deadline=None)
@given(BEARINGS, st.sampled_from(Foot), st.sampled_from(Direction))
def test_plan_solves_the_pendulum_on_the_grid(
    bearing: float, foot: Foot, direction: Direction
) -> None:
    """Velocity and acceleration by differences inside the phases."""
    plan = start(bearing, foot, direction, ManeuverPlanner(GaitSettings()), 6)
    h = 1e-4
    times = np.arange(0.05, 3.5, 0.01)
    gaps = np.abs(times[:, None] - plan.schedule.starts).min(axis=1)
    times = times[gaps > 2 * h]
    ahead, here, behind = (plan.sample(times + d) for d in (h, 0.0, -h))
    speed = (ahead.com - behind.com) / (2 * h)
    force = (ahead.com_velocity - behind.com_velocity) / (2 * h)
    np.testing.assert_allclose(speed, here.com_velocity, atol=1e-6)
    lever = plan.gait.eta**2 * (here.com - here.zmp)
    np.testing.assert_allclose(force, lever, atol=1e-5)
    dcm = here.com + here.com_velocity / plan.gait.eta
    np.testing.assert_allclose(here.dcm, dcm, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(BEARINGS, st.sampled_from(Foot), st.sampled_from(Direction))
def test_mirrored_bearing_mirrors_everything(
    bearing: float, foot: Foot, direction: Direction
) -> None:
    times = np.arange(0.0, 4.0, 0.03)
    one = start(bearing, foot, direction).sample(times)
    other = start(-bearing, foot.other, direction).sample(times)
    for name in ("zmp", "dcm", "com", "com_velocity"):
        mirrored = getattr(other, name) * [1, -1]
        np.testing.assert_allclose(mirrored, getattr(one, name), atol=1e-12)
    np.testing.assert_allclose(
        other.left_foot * [1, -1, -1], one.right_foot, atol=1e-12
    )
    np.testing.assert_allclose(other.left_height, one.right_height)


@given(st.lists(BEARINGS, min_size=2, max_size=8), st.sampled_from(Direction))
def test_com_is_continuous_through_any_replans(
    bearings: list[float], direction: Direction
) -> None:
    """Position, velocity and acceleration, however the bearing jumps."""
    plan = start(bearings[0], direction=direction, count=5)
    for bearing in bearings[1:]:
        end = plan.sample([plan.schedule.first_step_duration])
        new = follow(plan, bearing)
        begin = new.sample([0.0])
        frame = Pose(*plan.placements[2])
        spin = Pose(0.0, 0.0, frame.theta)
        for name, to_old in (
            ("com", frame),
            ("com_velocity", spin),
            ("zmp", frame),
        ):
            back = to_old.transform_points(getattr(begin, name))
            np.testing.assert_allclose(back, getattr(end, name), atol=1e-9)
        assert new.margin(new.schedule.first_step_duration) > 0.02
        plan = new


def test_swing_foot_lifts_off_and_touches_down_at_rest() -> None:
    plan = start(0.9, count=4)
    gait = PLANNER.settings
    lift = gait.start_support
    touch = lift + gait.single_support
    h = 1e-4
    for time in (lift, touch):
        near = plan.sample([time - h, time, time + h])
        rate = np.diff(near.left_foot, axis=0) / h
        assert np.abs(rate).max() < 1e-4
        assert np.abs(near.left_height).max() < 1e-6
    middle = plan.sample([0.5 * (lift + touch)])
    assert middle.left_height[0] == pytest.approx(gait.step_height)
    end = plan.sample([plan.schedule.duration])
    np.testing.assert_allclose(end.left_foot[0], plan.placements[4])
    np.testing.assert_allclose(end.right_foot[0], plan.placements[5])


def test_horizon_of_five_steps_decides_the_next_one() -> None:
    """Truncation: how the next step begins after a short and a long plan.

    The CoM of now is given, so what a horizon decides is the DCM at the end
    of the step; it falls by exp(-eta T) with every footstep.
    """
    state = CenterState((0.01, 0.03), (0.05, -0.1))
    ends = []
    for count in (3, 4, 5, 20):
        plan = PLANNER.plan(
            0.6,
            Direction.FORWARD,
            first_foot=Foot.LEFT,
            state=state,
            count=count,
        )
        end = plan.sample([plan.schedule.first_step_duration])
        ends.append([end.dcm[0], end.com[0]])
    off = [np.hypot(*(dcm - ends[-1][0])) for dcm, _ in ends[:-1]]
    gait = PLANNER.settings
    fade = np.exp(-gait.eta * gait.step_duration)
    assert off[1] == pytest.approx(fade * off[0], rel=0.05)
    assert off[2] == pytest.approx(fade * off[1], rel=0.05)
    assert 1e-7 < off[2] < 2e-7
    assert np.hypot(*(ends[2][1] - ends[-1][1])) < 0.5 * off[2]


def test_halt_ends_at_rest_with_the_feet_abreast() -> None:
    state = CenterState((0.02, 0.04), (0.05, -0.1))
    plan = PLANNER.plan_halt(
        first_foot=Foot.LEFT, state=state, swing_start=Pose(-0.04, 0.1, 0.0)
    )
    rest = plan.sample([plan.schedule.duration + 3.0])
    np.testing.assert_allclose(rest.left_foot[0], [0.0, 0.1, 0.0])
    np.testing.assert_allclose(rest.com[0], [0.02, 0.05], atol=1e-6)
    np.testing.assert_allclose(rest.com_velocity[0], 0.0, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "value"), [("foot_spacing", 0.05), ("zmp_forward", 0.2)]
)
def test_impossible_gait_is_refused_by_name(name: str, value: Any) -> None:
    with pytest.raises(PlanError, match=f"{name} must .*got '?{value}"):
        replace(GaitSettings(), **{name: value})


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("saturated", [False, True])
@given(BEARINGS, st.floats(0.05, 1.0))
def test_a_speed_factor_shortens_strides_and_keeps_turns(
    direction: Direction, saturated: bool, bearing: float, factor: float
) -> None:
    """Of the template: the soles stand half a spacing beside it."""

    def path(factor: float) -> tuple[np.ndarray, np.ndarray]:
        plan = PLANNER.plan(
            bearing,
            direction,
            first_foot=Foot.LEFT,
            standing=True,
            drive=TemplateDrive(saturated, factor),
        )
        x, y, theta = plan.placements[2:].T
        side = np.where(np.arange(len(x)) % 2, -0.05, 0.05)
        middle = (x + side * np.sin(theta), y - side * np.cos(theta))
        return np.stack(middle) - [[0.0], [0.05]], theta

    way, turn = path(factor)
    whole, full = path(1.0)
    np.testing.assert_allclose(way, factor * whole, atol=1e-12)
    np.testing.assert_allclose(turn, full, atol=1e-12)
