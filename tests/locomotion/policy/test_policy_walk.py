"""Test learned legs behind the interface of locomotion."""

from math import pi

import pytest

from stepaside.locomotion.locomotion import MotionRequest, template_velocity
from stepaside.planning import Direction, GaitSettings
from stepaside.strategies import STAND, Intent

GAIT = GaitSettings(speed=0.5, gain=0.4, stride=0.2)


@pytest.mark.parametrize("direction", Direction)
def test_a_request_becomes_the_velocity_of_the_template(
    direction: Direction,
) -> None:
    """Equations (7) and (8), both slowed down by the pace."""
    request = MotionRequest(Intent(heading=0.5), direction, False)
    velocity = template_velocity(request, GAIT)
    assert velocity == pytest.approx((0.5 * direction.value, 0.0, 0.2))
    slow = MotionRequest(Intent(0.5, 0.5, pace=0.5), direction, False)
    assert template_velocity(slow, GAIT) == pytest.approx(
        (0.125 * direction.value, 0.0, 0.1)
    )


@pytest.mark.parametrize("heading", [-3.0, -0.1, 0.5])
def test_a_saturated_request_turns_at_the_rate_of_the_gain(
    heading: float,
) -> None:
    """Equation (6)."""
    request = MotionRequest(Intent(heading), Direction.FORWARD, True)
    turn = 0.4 if heading > 0.0 else -0.4
    assert template_velocity(request, GAIT) == pytest.approx((0.5, 0.0, turn))


def test_standing_is_no_velocity() -> None:
    request = MotionRequest(STAND, Direction.FORWARD, False)
    assert template_velocity(request, GAIT) == (0.0, 0.0, 0.0)


def test_a_turn_on_the_spot_turns() -> None:
    request = MotionRequest(Intent(pi, 0.05), Direction.FORWARD, False)
    assert template_velocity(request, GAIT) == pytest.approx(
        (0.025, 0.0, 0.4 * pi)
    )
