"""Test roll and pitch from gyro and accelerometer."""

from math import hypot, nan

import numpy as np
import pytest

from stepaside.core.constants import GRAVITY
from stepaside.core.poses import Array
from stepaside.core.rotations import rotation
from stepaside.perception.attitude import CALIBRATION, AttitudeFilter
from stored_values import compare_stored, summed

TICK = 0.004
GAIN, BIAS_GAIN = 0.5, 0.06  # [1/s], [1/s^2]
REST = (0.0, 0.0)


def force(
    roll: float, pitch: float, ahead: float = 0.0, left: float = 0.0
) -> Array:
    """Specific force of a tilted torso that accelerates, in its frame."""
    level = np.array([ahead, left, GRAVITY])
    felt: Array = rotation(roll, pitch, 0.0).T @ level
    return felt


def stood(
    roll: float = 0.0,
    pitch: float = 0.0,
    bias: tuple[float, float] = (0.0, 0.0),
    correction: float = GAIN,
    bias_correction: float = BIAS_GAIN,
) -> AttitudeFilter:
    """Filter of a robot that has stood still, with a gyro's bias."""
    attitude = AttitudeFilter(correction, bias_correction)
    gyro = np.array([*bias, 0.0])
    while not attitude.ready:
        attitude.update(gyro, force(roll, pitch), REST, TICK)
    return attitude


def run(
    attitude: AttitudeFilter, gyro: Array, felt: Array, duration: float
) -> None:
    for _ in range(round(duration / TICK)):
        attitude.update(gyro, felt, REST, TICK)


def test_it_is_ready_after_a_second_of_standing() -> None:
    attitude = AttitudeFilter(GAIN, BIAS_GAIN)
    assert attitude.roll == attitude.pitch == 0.0
    ticks = 0
    while not attitude.ready:
        assert attitude.rate == (0.0, 0.0, 0.0)
        attitude.update(np.zeros(3), force(0.0, 0.0), REST, TICK)
        ticks += 1
    assert ticks * TICK == pytest.approx(1.0, abs=1.5 * TICK)
    assert CALIBRATION == 1.0


@pytest.mark.parametrize(("roll", "pitch"), [(0.2, -0.1), (-0.3, 0.25)])
def test_standing_measures_the_tilt(roll: float, pitch: float) -> None:
    attitude = stood(roll, pitch)
    assert (attitude.roll, attitude.pitch) == pytest.approx((roll, pitch))


def test_the_gyro_is_integrated_as_euler_rates() -> None:
    """A tilted torso that spins: Euler rates against matrices."""
    h = 1e-4
    attitude = stood(0.3, -0.4, correction=0.0, bias_correction=0.0)
    gyro = np.array([0.5, -0.7, 0.9])
    attitude.update(gyro, force(0.3, -0.4), REST, h)
    x, y, z = h * gyro
    turn = np.array([[1.0, -z, y], [z, 1.0, -x], [-y, x, 1.0]])
    turned = rotation(0.3, -0.4, 0.0) @ turn
    assert attitude.roll == pytest.approx(
        np.arctan2(turned[2, 1], turned[2, 2]), abs=1e-7
    )
    assert attitude.pitch == pytest.approx(-np.arcsin(turned[2, 0]), abs=1e-7)


@pytest.mark.parametrize(("roll", "pitch"), [(0.02, 0.0), (-0.03, 0.02)])
def test_gravity_corrects_at_the_given_gain(roll: float, pitch: float) -> None:
    """To first order d(angle)/dt = k (true - angle)."""
    attitude = stood(bias_correction=0.0)
    attitude.update(np.zeros(3), force(roll, pitch), REST, TICK)
    step = GAIN * TICK
    assert attitude.roll == pytest.approx(step * roll, rel=1e-3, abs=1e-9)
    assert attitude.pitch == pytest.approx(step * pitch, rel=1e-3, abs=1e-9)
    run(attitude, np.zeros(3), force(roll, pitch), 40.0)
    assert attitude.roll == pytest.approx(roll, abs=1e-5)
    assert attitude.pitch == pytest.approx(pitch, abs=1e-5)


@pytest.mark.parametrize(
    "bias", [(0.01, 0.0), (-0.01, 0.0), (0.0, 0.01), (0.0, -0.01)]
)
def test_a_drifting_bias_is_estimated(bias: tuple[float, float]) -> None:
    """With the wrong sign the filter would diverge."""
    attitude = stood()
    gyro = np.array([*bias, 0.0])
    attitude.update(gyro, force(0.0, 0.0), REST, TICK)
    assert hypot(*attitude.rate[:2]) == pytest.approx(0.01)
    run(attitude, gyro, force(0.0, 0.0), 60.0)
    assert attitude.rate == pytest.approx((0.0, 0.0, 0.0), abs=1e-4)
    assert (attitude.roll, attitude.pitch) == pytest.approx(REST, abs=1e-4)


@pytest.mark.parametrize(("ahead", "left"), [(1.0, 0.0), (0.0, -1.5)])
def test_known_acceleration_does_not_tilt(ahead: float, left: float) -> None:
    attitude = stood(0.1, -0.2)
    felt = force(0.1, -0.2, ahead, left)
    for _ in range(500):
        attitude.update(np.zeros(3), felt, (ahead, left), TICK)
    assert (attitude.roll, attitude.pitch) == pytest.approx((0.1, -0.2))
    assert attitude.rate == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_free_fall_corrects_nothing() -> None:
    attitude = stood(0.1, 0.1)
    run(attitude, np.zeros(3), np.array([0.5, 0.5, 0.5]), 1.0)
    assert (attitude.roll, attitude.pitch) == pytest.approx((0.1, 0.1))
    attitude.update(np.zeros(3), np.array([0.6, 0.6, 0.6]), REST, TICK)
    assert attitude.roll != 0.1


def test_a_gyro_with_two_axes_measures_roll_and_pitch() -> None:
    attitudes = [
        AttitudeFilter(GAIN, 0.0, calibration=calibration)
        for calibration in (0.0, CALIBRATION)
    ]
    for attitude in attitudes:
        run(attitude, np.array([0.0, 0.0, nan]), force(0.0, 0.0), 2.0)
        run(attitude, np.array([0.1, -0.2, nan]), force(0.0, 0.0), 0.1)
        whole = AttitudeFilter(GAIN, 0.0, calibration=0.0)
        run(whole, np.array([0.1, -0.2, 0.0]), force(0.0, 0.0), 0.1)
        assert attitude.roll == pytest.approx(whole.roll, rel=1e-9)
        assert attitude.pitch == pytest.approx(whole.pitch, rel=1e-9)


def test_random_readings_turn_the_torso_as_stored() -> None:
    draw, attitude, found = np.random.default_rng(2), stood(0.1, -0.2), []
    for _ in range(300):
        felt = force(0.1, -0.2) + draw.normal(0.0, 3.0, 3)
        pushed = draw.normal(0.0, 1.0, 2).tolist()
        attitude.update(draw.normal(0.1, 2.0, 3), felt, pushed, TICK)
        found += [attitude.roll, attitude.pitch, attitude.rate]
        found.append(float(attitude.turning[0]))
    compare_stored("numbers.json", "attitude", summed(found), 1e-5)
