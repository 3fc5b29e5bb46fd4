"""Test the direction of gravity from gyro and accelerometer."""

from itertools import pairwise

import numpy as np
import pytest

from stepaside.core.constants import GRAVITY
from stepaside.core.poses import Array
from stepaside.locomotion.policy.policy_legs import GravityFilter

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
