"""Test the direction of gravity from gyro and accelerometer."""

from itertools import pairwise

import numpy as np
import pytest

from stepaside.core.constants import GRAVITY
from stepaside.core.poses import Array
from stepaside.locomotion.policy.gravity_filter import GravityFilter

TICK = 0.004
NONE = np.zeros(3)


def up_at(roll: float, pitch: float) -> Array:
    """Upward direction in a torso with roll and pitch."""
    sr, cr, sp, cp = np.sin(roll), np.cos(roll), np.sin(pitch), np.cos(pitch)
    return np.array([-sp, cp * sr, cp * cr])


def standing(up: Array, velocity: Array = NONE) -> GravityFilter:
    """Filter of a robot that has stood for a second."""
    found = GravityFilter(velocity, TICK)
    while not found.knows:
        found.take(NONE, GRAVITY * up)
    return found


@pytest.mark.parametrize("roll", [-0.2, 0.0, 0.1])
@pytest.mark.parametrize("pitch", [-0.1, 0.0, 0.3])
def test_a_standing_robot_knows_its_tilt(roll: float, pitch: float) -> None:
    found = standing(up_at(roll, pitch))
    assert found.tilt == pytest.approx((roll, pitch), abs=0.02)


def test_a_robot_that_sways_before_it_is_ready_knows_its_tilt() -> None:
    """A policy may not rest in its default posture."""
    found, angle = GravityFilter(NONE, TICK), 0.0
    while not found.knows:
        force = GRAVITY * up_at(0.0, angle)
        found.take(np.array([0.0, 0.3, 0.0]), force)
        angle += 0.3 * TICK
        assert found.tilt[1] == pytest.approx(angle, abs=2e-3)


@pytest.mark.parametrize("axis", [0, 1])
def test_the_tilt_follows_the_gyro(axis: int) -> None:
    """Over half a second of 1 rad/s about one axis of the torso."""
    found = standing(up_at(0.0, 0.0))
    rate = np.eye(3)[axis]
    for i in range(1, 126):
        angle = i * TICK
        up = up_at(angle, 0.0) if axis == 0 else up_at(0.0, angle)
        found.take(rate, GRAVITY * up)
    assert found.tilt[axis] == pytest.approx(0.5, abs=2e-3)


def test_a_turn_about_the_vertical_leaves_the_tilt() -> None:
    up = up_at(0.2, 0.1)
    found = standing(up)
    for i in range(1, 500):
        c, s = np.cos(-i * TICK), np.sin(-i * TICK)
        turned = np.array(
            [c * up[0] - s * up[1], s * up[0] + c * up[1], up[2]]
        )
        found.take(np.array([0.0, 0.0, 1.0]), GRAVITY * turned)
    np.testing.assert_allclose(found.up, turned, atol=0.01)


def test_a_constant_gyro_bias_is_learned() -> None:
    up = up_at(0.0, 0.0)
    found, bias = standing(up), np.array([0.01, -0.02, 0.0])
    for _ in range(round(120.0 / TICK)):
        found.take(bias, GRAVITY * up)
    assert found.tilt == pytest.approx((0.0, 0.0), abs=1e-4)


@pytest.mark.parametrize("lean", [-0.1, 0.0, 0.1])
def test_the_heading_of_a_torso_that_rolls_and_pitches_stays(
    lean: float,
) -> None:
    """Its axis moves about a cone, so that its own yaw rate has a mean."""
    tilts = [
        (0.1 * np.sin(12.0 * t), lean + 0.1 * np.cos(12.0 * t))
        for t in TICK * np.arange(5000)
    ]
    found = standing(up_at(*tilts[0]))
    turned = about_axis = 0.0
    for last, (roll, pitch) in pairwise(tilts):
        p, q = np.subtract((roll, pitch), last) / TICK
        middle = 0.5 * (roll + last[0])
        gyro = np.array([p, q * np.cos(middle), -q * np.sin(middle)])
        found.take(gyro, GRAVITY * up_at(roll, pitch))
        turned += TICK * found.turning.item(0)
        about_axis += TICK * gyro.item(2)
    assert abs(about_axis) > 1.0
    assert abs(turned) < 0.02


def test_vertical_impacts_leave_the_tilt() -> None:
    """Even where they coincide with a swing of the torso."""
    found = standing(up_at(0.0, 0.0))
    errors = []
    for i in range(round(60.0 / TICK)):
        phase = 2.0 * np.pi * 2.0 * i * TICK
        pitch, rate = 0.05 * np.sin(phase), 0.05 * 4.0 * np.pi * np.cos(phase)
        up = up_at(0.0, pitch)
        force = (GRAVITY + 5.0 * np.sin(phase)) * up
        found.take(np.array([0.0, rate, 0.0]), force)
        errors.append(found.tilt[1] - pitch)
    assert abs(np.mean(errors[-1000:])) < 2e-3


def test_a_known_acceleration_is_no_tilt() -> None:
    """On a circle to the left, at 1 m/s and 1 rad/s."""
    found = standing(up_at(0.0, 0.0), np.array([1.0, 0.0, 0.0]))
    rate, force = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, GRAVITY])
    found.take(rate, GRAVITY * up_at(0.0, 0.0))
    for _ in range(1000):
        found.take(rate, force)
    assert found.tilt == pytest.approx((0.0, 0.0), abs=1e-9)
