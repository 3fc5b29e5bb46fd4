"""Test the tilt of a torso that is not asked to stand still first."""

from math import cos, exp, sin

import numpy as np
import pytest

from stepaside.perception.tilt import TRUST, TiltFilter
from stepaside.planning.settings import GRAVITY
from stepaside.poses import Array
from stepaside.robots.head import rotation

TICK = 0.004
STILL = np.zeros(3)


def up(roll: float, pitch: float) -> Array:
    """Specific force of a torso at rest, in its own frame."""
    axes: Array = rotation(roll, pitch, 0.0)
    felt: Array = GRAVITY * axes[2]
    return felt


def test_it_begins_upright_whatever_the_accelerometer_says() -> None:
    assert TiltFilter().update(5.0, STILL, up(0.3, 0.2)) == (0.0, 0.0)


@pytest.mark.parametrize(("roll", "pitch"), [(0.1, 0.0), (-0.2, 0.15)])
def test_gravity_is_believed_in_the_end(roll: float, pitch: float) -> None:
    tilt = TiltFilter()
    for i in range(round(20.0 * TRUST / TICK)):
        seen = tilt.update(TICK * i, STILL, up(roll, pitch))
    assert seen == pytest.approx((roll, pitch), abs=1e-6)


def test_gravity_is_believed_at_the_rate_of_trust() -> None:
    tilt = TiltFilter()
    for i in range(round(TRUST / TICK) + 1):
        roll, pitch = tilt.update(TICK * i, STILL, up(0.1, -0.05))
    assert roll == pytest.approx(0.1 * (1.0 - exp(-1.0)), rel=0.01)
    assert pitch == pytest.approx(-0.05 * (1.0 - exp(-1.0)), rel=0.01)
    assert TRUST == 2.0


def test_a_gap_longer_than_trust_leaves_gravity_alone() -> None:
    tilt = TiltFilter()
    tilt.update(0.0, STILL, up(0.1, 0.1))
    seen = tilt.update(10.0, STILL, up(0.1, 0.1))
    assert seen == pytest.approx((0.1, 0.1))


def test_the_gyro_is_integrated_as_the_frames_turn() -> None:
    """A tilted torso that spins: Euler rates against matrices."""
    h = 1e-4
    frame = rotation(0.3, -0.4, 0.0)
    gyro = np.array([0.5, -0.7, 0.9])
    tilt = TiltFilter()
    tilt._roll, tilt._pitch = 0.3, -0.4
    tilt.update(0.0, gyro, up(0.3, -0.4))
    roll, pitch = tilt.update(h, gyro, up(0.3, -0.4))
    x, y, z = h * gyro
    turn = np.array([[1.0, -z, y], [z, 1.0, -x], [-y, x, 1.0]])
    turned = frame @ turn
    expected = (
        np.arctan2(turned[2, 1], turned[2, 2]),
        -np.arcsin(turned[2, 0]),
    )
    assert (roll, pitch) == pytest.approx(expected, abs=1e-7)


def test_yaw_of_an_upright_torso_is_no_tilt() -> None:
    tilt = TiltFilter()
    for i in range(100):
        seen = tilt.update(TICK * i, np.array([0.0, 0.0, 2.0]), up(0.0, 0.0))
    assert seen == pytest.approx((0.0, 0.0), abs=1e-12)


def test_free_fall_is_no_tilt_and_no_time() -> None:
    """Without weight nothing is up; time goes on all the same."""
    tilt = TiltFilter()
    tilt.update(0.0, STILL, up(0.0, 0.0))
    falling = np.array([1.0, 1.0, -0.1])
    assert tilt.update(1.0, np.ones(3), falling) == (0.0, 0.0)
    assert tilt.update(1.5, np.ones(3), np.zeros(3)) == (0.0, 0.0)
    assert tilt.update(1.5, np.ones(3), 0.0 * falling) == (0.0, 0.0)
    roll, pitch = tilt.update(1.6, STILL, up(0.1, 0.0))
    assert roll == pytest.approx(0.1 * 0.1 / TRUST)
    assert pitch == pytest.approx(0.0, abs=1e-12)


def test_a_level_rotation_about_a_rolled_axis_is_exact() -> None:
    """Heading rate w about the vertical leaves roll and pitch alone."""
    tilt = TiltFilter()
    tilt._roll, tilt._pitch = 0.2, 0.3
    gyro = rotation(0.2, 0.3, 0.0).T @ np.array([0.0, 0.0, 1.5])
    assert gyro == pytest.approx(
        1.5 * np.array([-sin(0.3), cos(0.3) * sin(0.2), cos(0.3) * cos(0.2)])
    )
    for i in range(50):
        seen = tilt.update(TICK * i, gyro, up(0.2, 0.3))
    assert seen == pytest.approx((0.2, 0.3), abs=1e-9)
