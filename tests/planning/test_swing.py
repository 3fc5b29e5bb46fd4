"""Test the swing-foot trajectories."""

from typing import get_args

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.planning.gait_settings import SwingProfile
from stepaside.planning.schedule import (
    swing_acceleration,
    swing_height,
    swing_progress,
)

H = 1e-3
PROFILES: tuple[SwingProfile, ...] = get_args(SwingProfile)


def derivative(values: Array, order: int, h: float) -> Array:
    """Central differences of equally spaced values."""
    for _ in range(order):
        values = (values[2:] - values[:-2]) / (2.0 * h)
    return values


def test_progress_is_the_minimum_jerk_polynomial() -> None:
    """Its sixth derivative vanishes, and so do rates at the ends."""
    s = np.array([0.1, 0.25, 0.5, 0.8])
    closed = 10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5
    np.testing.assert_allclose(swing_progress(s), closed, atol=1e-15)
    np.testing.assert_array_equal(swing_progress([0.0, 1.0]), [0.0, 1.0])


@pytest.mark.parametrize("profile", PROFILES)
def test_acceleration_is_the_second_derivative(profile: SwingProfile) -> None:
    s = np.array([0.0, 0.05, 0.3, 0.5, 0.8, 1.0])
    told = np.polynomial.polynomial.polyval(s, swing_acceleration(profile))
    inside = np.clip(s, 0.05, 0.95)
    bent = [
        derivative(swing_progress(x + H * np.arange(-2, 3), profile), 2, H)
        for x in inside
    ]
    np.testing.assert_allclose(
        told[1:-1], np.ravel(bent)[1:-1], rtol=1e-4, atol=1e-3
    )
    np.testing.assert_allclose(told[[0, -1]], 0.0, atol=1e-12)


def test_height_peaks_at_its_apex_half_way() -> None:
    phases = np.linspace(0.0, 1.0, 101)
    heights = swing_height(phases, 0.03)
    assert heights.max() == pytest.approx(0.03)
    assert phases[heights.argmax()] == pytest.approx(0.5)
    np.testing.assert_allclose(heights, heights[::-1], atol=1e-15)
    assert (np.diff(heights[:51]) > 0.0).all()
