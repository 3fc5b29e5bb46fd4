"""Test the step in progress, and the ZMP shifts and landings it allows."""

from dataclasses import replace
from math import exp, hypot, pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.core.poses import Pose
from stepaside.locomotion.zmp.control_settings import StabiliserSettings
from stepaside.locomotion.zmp.current_step import (
    Box,
    CurrentStep,
    adapted_landing,
    beyond,
    clip_to,
    first_step_of,
    resting_step,
    shifted_swing,
    zmp_box,
)
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
)
from stepaside.planning.gait_settings import SoleRectangle
from stepaside.planning.swing import swing_progress
from stepaside.robots.leg_kinematics import BodyReference

GAIT = GaitSettings()
LIMITS = StabiliserSettings()
SUPPORT = Pose(1.0, -2.0, 0.7)
BOX: Box = ((-0.05, -0.03), (0.07, 0.04))
BODY = BodyReference(
    (0.0, 0.0, 0.27), (0.1, 0.2, 0.01, 0.3), (0.4, 0.5, 0.02, 0.6)
)
VECTORS = st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))


def step(
    swing: Foot = Foot.LEFT,
    ahead: float = 0.04,
    aside: float = 0.1,
    **changes: Any,
) -> CurrentStep:
    """Step over a foot that stands somewhere, turned."""
    landing = SUPPORT.compose(Pose(ahead, swing.value * aside, 0.1))
    values: dict[str, Any] = {"remaining": 0.2, "progress": 0.5} | changes
    return CurrentStep(SUPPORT, swing, landing, walking=True, **values)


def test_a_quarter_turn_turns_vectors_by_hand() -> None:
    turned = step()._replace(support=Pose(5.0, 6.0, 0.5 * pi))
    assert turned.to_support(1.0, 2.0) == pytest.approx((2.0, -1.0))
    assert turned.from_support(1.0, 2.0) == pytest.approx((-2.0, 1.0))


@given(VECTORS)
def test_rotation_to_support_and_back_is_the_identity(
    vector: tuple[float, float],
) -> None:
    there = step().to_support(*vector)
    assert step().from_support(*there) == pytest.approx(vector, abs=1e-12)


def test_a_resting_step_stands_on_its_foot() -> None:
    rest = resting_step(SUPPORT, Foot.RIGHT)
    assert rest.support == rest.landing == SUPPORT
    assert rest.swing is Foot.RIGHT
    assert not rest.walking and rest.plan is None
    assert (rest.remaining, rest.progress, rest.passed) == (0.0, 1.0, 0.0)


@pytest.mark.parametrize("standing", [False, True])
@pytest.mark.parametrize("foot", Foot)
def test_step_of_a_plan_follows_its_clock(standing: bool, foot: Foot) -> None:
    plan = ManeuverPlanner(GAIT).plan(
        0.4,
        Direction.FORWARD,
        first_foot=foot,
        state=CenterState((0.0, 0.05), (0.0, 0.0)),
        standing=standing,
    )
    begins = GAIT.start_support if standing else 0.0
    for phase in (-0.1, 0.25, 0.9, 1.2):
        passed = begins + phase * GAIT.single_support
        made = first_step_of(plan, SUPPORT, passed)
        assert made.support == SUPPORT and made.swing is foot
        assert made.walking and made.plan is plan
        assert made.passed == passed
        rest = (1.0 - phase) * GAIT.single_support
        assert made.remaining == pytest.approx(rest)
        assert made.progress == pytest.approx(float(swing_progress(phase)))
        expected = SUPPORT.compose(Pose(*plan.placements[2]))
        assert made.landing == pytest.approx(expected)


def test_zmp_box_is_the_sole_about_the_anchor() -> None:
    """Standing on the left foot (the right swings): outside is left."""
    gait = replace(
        GAIT,
        sole=SoleRectangle(back=-0.06, front=0.1, outer=0.05, inner=0.04),
        zmp_forward=0.03,
    )
    on_left = zmp_box(Foot.RIGHT, gait, 0.01)
    assert on_left[0] == pytest.approx((-0.08, -0.03))
    assert on_left[1] == pytest.approx((0.06, 0.04))
    on_right = zmp_box(Foot.LEFT, gait, 0.01)
    assert on_right[0] == pytest.approx((-0.08, -0.04))
    assert on_right[1] == pytest.approx((0.06, 0.03))


@given(VECTORS)
def test_clipping_finds_the_nearest_point(
    value: tuple[float, float],
) -> None:
    nearest = clip_to(value, BOX)
    for axis in range(2):
        low, high = BOX[0][axis], BOX[1][axis]
        assert low <= nearest[axis] <= high
        if low <= value[axis] <= high:
            assert nearest[axis] == value[axis]
        else:
            assert nearest[axis] in (low, high)
            assert (value[axis] > high) == (nearest[axis] == high)


@given(VECTORS, st.floats(0.0, 0.1))
def test_beyond_removes_the_dead_zone(
    vector: tuple[float, float], radius: float
) -> None:
    x, y = beyond(*vector, radius)
    length = hypot(*vector)
    assert hypot(x, y) == pytest.approx(max(0.0, length - radius), abs=1e-12)
    assert x * vector[1] == pytest.approx(y * vector[0], abs=1e-12)
    assert x * vector[0] >= 0.0 and y * vector[1] >= 0.0


def test_a_zero_radius_leaves_the_vector_unchanged() -> None:
    assert beyond(0.3, -0.4, 0.0) == (0.3, -0.4)
    assert beyond(0.0, 0.0, 0.0) == (0.0, 0.0)


def shift(
    error: tuple[float, float], made: CurrentStep
) -> tuple[float, float]:
    """Shift of the landing in the support foot's axes."""
    moved = adapted_landing(error, made, BOX, GAIT, LIMITS)
    return made.to_support(*moved)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_error_within_the_sole_moves_no_foot(sign: float) -> None:
    """An error up to (1 - exp(-eta T)) of the box."""
    hold = 1.0 - exp(-GAIT.eta * 0.2)
    held = 0.99 * hold
    for edge in (BOX[0], BOX[1]):
        error = held * edge[0], held * edge[1]
        assert shift(error, step()) == pytest.approx((0.0, 0.0), abs=1e-9)
    # And a hair beyond it, some foot moves.
    x, _ = shift((1.01 * hold * BOX[0][0], 0.0), step())
    assert x < 0.0


@pytest.mark.parametrize("time", [0.05, 0.2])
def test_a_pendulum_confirms_where_the_foot_must_land(time: float) -> None:
    """Integrate xi' = eta (xi - p) with the ZMP at the edge of its box."""
    error = (0.055, 0.0)
    hold = 1.0 - exp(-GAIT.eta * time)
    edge = min(error[0] / hold, BOX[1][0])
    xi, h = error[0], time / 20000
    for _ in range(20000):
        middle = xi + 0.5 * h * GAIT.eta * (xi - edge)
        xi += h * GAIT.eta * (middle - edge)
    x, y = shift(error, step(ahead=-0.05, remaining=time))
    assert x == pytest.approx(xi, abs=1e-6)
    assert y == pytest.approx(0.0, abs=1e-12)


def test_a_landing_keeps_to_its_reach() -> None:
    limits = replace(LIMITS, reach_forward=0.07, reach_backward=0.06)
    for error, reach in ((5.0, 0.07), (-5.0, -0.06)):
        moved = adapted_landing((error, 0.0), step(), BOX, GAIT, limits)
        x, y = step().to_support(*moved)
        assert x + 0.04 == pytest.approx(reach)
        assert y == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("swing", Foot)
def test_a_landing_neither_crosses_nor_straddles(swing: Foot) -> None:
    side = swing.value
    near = 2.0 * GAIT.sole.inner + LIMITS.gap
    far = GAIT.foot_spacing + LIMITS.reach_outward
    for error, place in ((5.0, far), (-5.0, near)):
        x, y = shift((0.0, side * error), step(swing))
        assert side * y + 0.1 == pytest.approx(place)
        assert x == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("swing", Foot)
def test_a_landing_shifts_by_the_remaining_error(swing: Foot) -> None:
    """To either side of the plan, inside its limits."""
    hold = 1.0 - exp(-GAIT.eta * 0.2)
    grow = exp(GAIT.eta * 0.2)
    for sign in (1.0, -1.0):
        edge = BOX[1][1] if sign > 0.0 else BOX[0][1]
        error = hold * edge + sign * 0.003
        _, y = shift((0.0, error), step(swing))
        assert y == pytest.approx(sign * 0.003 * grow, rel=1e-6)


def test_a_plan_beyond_the_reach_is_left_alone_without_need() -> None:
    """Limits apply to the shift, not to the plan."""
    far = step(ahead=0.5, aside=0.3)
    assert shift((1e-4, 1e-4), far) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_an_error_at_touch_down_is_stepped_out_as_it_is() -> None:
    for remaining in (0.0, -0.1):
        made = step(ahead=0.0, remaining=remaining)
        x, _ = shift((0.03, 0.0), made)
        grow = exp(GAIT.eta * 1e-3)
        expected = grow * (0.03 - (1.0 - 1.0 / grow) * BOX[1][0])
        assert x == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("swing", Foot)
def test_the_swing_foot_takes_up_the_shift_as_it_goes(swing: Foot) -> None:
    made = step(swing, progress=0.25)
    body = shifted_swing(BODY, made, (0.04, -0.08))
    moved, stood = body.left_foot, body.right_foot
    was, stands = BODY.left_foot, BODY.right_foot
    if swing is Foot.RIGHT:
        moved, stood, was, stands = stood, moved, stands, was
    difference = np.subtract(moved, was)
    np.testing.assert_allclose(difference, [0.01, -0.02, 0.0, 0.0])
    assert stood == stands and body.com == BODY.com


def test_a_standing_robot_has_no_swing_shift() -> None:
    rest = resting_step(SUPPORT, Foot.LEFT)
    assert shifted_swing(BODY, rest, (0.1, 0.1)) is BODY
    assert shifted_swing(BODY, step(), (0.0, 0.0)) is BODY
    assert shifted_swing(BODY, step(), (0.0, 0.1)) != BODY
    assert shifted_swing(BODY, step(), (0.1, 0.0)) != BODY
