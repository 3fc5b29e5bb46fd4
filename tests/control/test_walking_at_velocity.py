"""Test the requests that follow a velocity command."""

from math import pi

import pytest

from stepaside.control.velocity_scheme import (
    limit_velocity,
    request_at_velocity,
)
from stepaside.locomotion.maneuver_walk import velocity_limits
from stepaside.planning import Direction, GaitSettings

GAIT = GaitSettings()
PACE = 0.4 / 0.547  # path time over walked time
FORWARD, BACKWARD = Direction.FORWARD, Direction.BACKWARD


def test_a_gait_is_as_fast_as_one_stride_a_step() -> None:
    speed, rate = velocity_limits(GAIT)
    assert speed == pytest.approx(0.04 / 0.547)
    assert rate == pytest.approx(0.2 * PACE * pi)


@pytest.mark.parametrize("forward", [0.05, 0.5, -0.5, -0.01])
@pytest.mark.parametrize("turn", [0.0, 0.1, -2.0])
def test_excessive_velocity_is_scaled_on_the_same_path(
    forward: float, turn: float
) -> None:
    speed, rate = velocity_limits(GAIT)
    v, w = limit_velocity(forward, turn, GAIT)
    assert v * turn == pytest.approx(w * forward)
    assert abs(v) <= speed + 1e-12 and abs(w) <= rate + 1e-12
    fits = abs(forward) <= speed and abs(turn) <= rate
    assert ((v, w) == (forward, turn)) == fits


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_half_the_speed_halves_the_stride_not_the_turn(
    sign: float,
) -> None:
    speed, _ = velocity_limits(GAIT)
    walk = request_at_velocity(sign * 0.5 * speed, 0.1, GAIT, under_way=None)
    assert walk.direction.value == sign
    assert walk.intent.speed_factor == pytest.approx(0.5)
    # k theta* is what the template turns by in path time.
    assert GAIT.gain * walk.intent.heading * PACE == pytest.approx(0.1)


def test_turning_in_place_keeps_position_and_direction() -> None:
    walk = request_at_velocity(0.0, -0.2, GAIT, under_way=BACKWARD)
    assert walk.direction is BACKWARD and walk.intent.heading < 0.0
    assert walk.intent.speed_factor == pytest.approx(1e-3)


def test_reversal_halts_first() -> None:
    for forward, under_way, walks in (
        (0.0, None, False),
        (0.05, BACKWARD, False),
        (0.05, FORWARD, True),
    ):
        request = request_at_velocity(forward, 0.0, GAIT, under_way=under_way)
        assert request.intent.walks == walks
