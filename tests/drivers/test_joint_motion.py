"""Test limits of joint targets and stiffness."""

import numpy as np
import pytest

from joint_fakes import MOTORS, TICK, status
from stepaside.drivers.joint_motion import (
    HOT,
    MIN_STIFFNESS,
    WARM,
    StiffnessRamp,
    TargetLimiter,
    derate_stiffness,
    posture_reached,
)

ONES = np.ones(4)


def test_targets_within_reach_are_not_touched() -> None:
    middle = 0.5 * (MOTORS.low + MOTORS.high)
    wanted = middle + 0.9 * MOTORS.speed * TICK
    limiter = TargetLimiter(middle, MOTORS, TICK)
    np.testing.assert_allclose(limiter.toward(wanted), wanted)


@pytest.mark.parametrize("end", [-1e9, 1e9])
def test_no_target_leaves_its_range_or_outruns_its_motor(end: float) -> None:
    limiter = TargetLimiter(np.zeros(3), MOTORS, TICK)
    last = limiter.target
    for _ in range(500):
        got = limiter.toward(np.full(3, end))
        assert np.all(np.abs(got - last) <= MOTORS.speed * TICK + 1e-12)
        last = got
    wanted = MOTORS.low + 0.01 if end < 0 else MOTORS.high - 0.01
    np.testing.assert_allclose(got, wanted)


def test_targets_that_are_not_finite_are_ignored() -> None:
    middle = 0.5 * (MOTORS.low + MOTORS.high)
    limiter = TargetLimiter(middle, MOTORS, TICK)
    wanted = np.array([np.nan, np.inf, np.nan])
    np.testing.assert_array_equal(limiter.toward(wanted), middle)
    np.testing.assert_array_equal(limiter.follow(wanted), middle)


def test_a_cool_joint_has_all_its_torque_and_a_hot_one_half() -> None:
    def share(degrees: float, heat: float = 0.0) -> float:
        hot = status(temperature=np.full(4, degrees), heat=np.full(4, heat))
        return float(derate_stiffness(ONES, hot)[0])

    assert share(20.0) == share(WARM) == 1.0
    assert share(HOT) == share(HOT + 50.0) == MIN_STIFFNESS
    half = 0.5 * (1.0 + MIN_STIFFNESS)
    assert share(0.5 * (WARM + HOT)) == pytest.approx(half)
    assert share(20.0, heat=3.0) == 0.0


def test_only_the_hot_joint_is_cut() -> None:
    hot = status(temperature=np.array([30.0, HOT, 30.0, 30.0]))
    cut = derate_stiffness(ONES, hot)
    assert cut.tolist() == [1.0, MIN_STIFFNESS, 1.0, 1.0]


def test_stiffness_takes_a_second_to_grow_and_half_of_one_to_fade() -> None:
    ramp = StiffnessRamp(TICK)
    grown = [ramp.toward(1.0) for _ in range(50)]
    assert grown[0] == pytest.approx(TICK) and grown[-1] == pytest.approx(1.0)
    assert grown[-2] < 1.0
    faded = [ramp.toward(0.0) for _ in range(25)]
    assert faded[-1] == pytest.approx(0.0) and faded[-2] > 0.01


def test_a_leg_that_is_held_has_not_reached_its_posture() -> None:
    goal = np.array([0.1, 0.2, 0.3])
    held = goal + np.array([0.0, 0.5, 0.0])
    aside = goal + np.array([0.0, 0.0, 0.5])  # not a leg
    assert posture_reached(goal, goal, aside, MOTORS.legs)
    assert not posture_reached(goal, goal, held, MOTORS.legs)
    assert not posture_reached(held, goal, goal, MOTORS.legs)
