"""Test the strategy that follows a velocity command."""

from math import pi

import pytest

from stepaside.games.velocity_walker import CommandedVelocity
from stepaside.locomotion.maneuver_walk import velocity_limits
from stepaside.planning import Direction, GaitSettings
from stepaside.strategies import Intent, Knowledge, Limits
from stepaside.strategies.velocity_set import BodyVelocity

GAIT = GaitSettings()
LIMITS = Limits(GAIT.speed, GAIT.gain, GAIT.stride, GAIT.step_duration)
PACE = 0.4 / 0.547  # path time over walked time
FORWARD, BACKWARD = Direction.FORWARD, Direction.BACKWARD


def step(
    strategy: CommandedVelocity, forward: float, turn: float, *, moving: bool
) -> Intent:
    """Return the next step at a velocity."""
    strategy.command = BodyVelocity(forward, 0.0, turn)
    known = Knowledge(0.0, 0.0, 1.0, LIMITS, moving=moving)
    return strategy.decide(known, None)[0]


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
    strategy = CommandedVelocity(GAIT)
    strategy.command = BodyVelocity(forward, 0.2, turn)
    v, lateral, w = strategy.velocity
    assert v * turn == pytest.approx(w * forward) and lateral == 0.0
    assert abs(v) <= speed + 1e-12 and abs(w) <= rate + 1e-12
    fits = abs(forward) <= speed and abs(turn) <= rate
    assert ((v, w) == (forward, turn)) == fits


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_half_the_speed_halves_the_stride_not_the_turn(sign: float) -> None:
    speed, _ = velocity_limits(GAIT)
    strategy = CommandedVelocity(GAIT)
    walk = step(strategy, sign * 0.5 * speed, 0.1, moving=False)
    assert strategy.direction.value == sign
    assert walk.speed_factor == pytest.approx(0.5)
    # k theta* is what the template turns by in path time.
    assert GAIT.gain * walk.heading * PACE == pytest.approx(0.1)


def test_turning_in_place_keeps_position_and_direction() -> None:
    strategy = CommandedVelocity(GAIT)
    step(strategy, -0.05, 0.0, moving=False)
    walk = step(strategy, 0.0, -0.2, moving=True)
    assert strategy.direction is BACKWARD and walk.heading < 0.0
    assert walk.speed_factor == pytest.approx(1e-3)


def test_reversal_halts_first() -> None:
    strategy = CommandedVelocity(GAIT)
    assert not step(strategy, 0.0, 0.0, moving=False).walks
    assert step(strategy, -0.05, 0.0, moving=False).walks
    assert not step(strategy, 0.05, 0.0, moving=True).walks
    assert step(strategy, 0.05, 0.0, moving=False).walks
    assert step(strategy, 0.05, 0.0, moving=True).walks
    assert strategy.direction is FORWARD
