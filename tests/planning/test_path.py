"""Test the template's trajectory (paper, Sec. III-B)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.planning.path import Direction, UnicycleTrajectory

SPEED, GAIN = 0.1, 0.2  # [m/s], [1/s]
ANGLES = st.floats(-3.1, 3.1)


def make(bearing: float, saturated: bool = False) -> UnicycleTrajectory:
    return UnicycleTrajectory(
        bearing, SPEED, GAIN, Direction.FORWARD, saturated
    )


@given(ANGLES, st.booleans())
def test_trajectory_solves_the_unicycle_equations(
    bearing: float, saturated: bool
) -> None:
    """Central differences of the pose; the corner at t_s is left out."""
    times = np.linspace(0.1, 4.0, 9)
    h = 1e-5
    path = make(bearing, saturated)
    ahead, here, behind = (path.poses(times + d) for d in (h, 0.0, -h))
    rate = (ahead - behind) / (2.0 * h)
    theta = here[:, 2]
    np.testing.assert_allclose(rate[:, 0], SPEED * np.cos(theta), atol=1e-7)
    np.testing.assert_allclose(rate[:, 1], SPEED * np.sin(theta), atol=1e-7)
    turning = times < 0.99 * abs(bearing) / GAIN if saturated else times > 0
    omega = GAIN * (np.sign(bearing) if saturated else bearing)
    np.testing.assert_allclose(rate[turning, 2], omega, atol=1e-6)


@given(ANGLES, st.booleans())
def test_heading_ends_at_the_bearing_and_stays(
    bearing: float, saturated: bool
) -> None:
    """Fails with (11) as printed, which ends at one radian."""
    end = max(1.0, abs(bearing)) / GAIN
    poses = make(bearing, saturated).poses([end, 2.0 * end])
    np.testing.assert_allclose(poses[:, 2], bearing, atol=1e-12)
    chord = poses[1, :2] - poses[0, :2]
    expected = SPEED * end * np.array([np.cos(bearing), np.sin(bearing)])
    np.testing.assert_allclose(chord, expected, atol=1e-12)


def test_arc_has_the_radius_of_the_paper() -> None:
    bearing = 1.1
    poses = make(bearing).poses(np.linspace(0.0, 5.0, 20))
    centre = np.array([0.0, SPEED / (GAIN * bearing)])
    radius = np.hypot(*(poses[:, :2] - centre).T)
    np.testing.assert_allclose(radius, centre[1], rtol=1e-12)


@given(ANGLES, st.booleans())
def test_backward_is_the_reflection_with_the_same_heading(
    bearing: float, saturated: bool
) -> None:
    times = np.linspace(0.0, 12.0, 9)
    ahead = make(bearing, saturated).poses(times)
    back = UnicycleTrajectory(
        bearing, SPEED, GAIN, Direction.BACKWARD, saturated
    ).poses(times)
    np.testing.assert_allclose(back, ahead * [-1.0, -1.0, 1.0], atol=1e-12)


@pytest.mark.parametrize("bearing", [1e-300, 1e-12, 1e-6])
def test_no_singularity_at_zero_bearing(bearing: float) -> None:
    times = np.linspace(0.0, 10.0, 11)
    straight = make(0.0).poses(times)
    assert np.isfinite(straight).all()
    bent = make(bearing).poses(times)
    np.testing.assert_allclose(bent, straight, atol=2.0 * bearing + 1e-15)
