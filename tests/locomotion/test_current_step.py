"""Test the step in progress, and the ZMP shifts and landings it allows."""

from dataclasses import replace
from math import exp
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.locomotion.control_settings import StabiliserSettings
from stepaside.locomotion.locomotion import CurrentStep
from stepaside.locomotion.zmp.current_step import (
    Box,
    adapted_landing,
    shifted_swing,
    zmp_box,
)
from stepaside.planning import Foot, GaitSettings
from stepaside.planning.gait_settings import SoleRectangle
from stepaside.robots.leg_kinematics import BodyReference

GAIT = GaitSettings()
LIMITS = StabiliserSettings()
SUPPORT = Pose(1.0, -2.0, 0.7)
BOX: Box = ((-0.05, -0.03), (0.07, 0.04))
BODY = BodyReference(
    (0.0, 0.0, 0.27), (0.1, 0.2, 0.01, 0.3), (0.4, 0.5, 0.02, 0.6)
)


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


def shift(
    error: tuple[float, float], made: CurrentStep
) -> tuple[float, float]:
    """Shift of the landing in the support foot's axes."""
    moved = adapted_landing(error, made, BOX, GAIT, LIMITS)
    return made.to_support(*moved)


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
