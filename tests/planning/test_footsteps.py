"""Test footstep placement (paper, Sec. III-C)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.core.poses import Array
from stepaside.planning import Direction, Foot
from stepaside.planning.path import UnicycleTrajectory, place_footsteps

SPEED, GAIN = 0.1, 0.2
WALK = {"count": 20, "stride": 0.04, "foot_spacing": 0.1}


def place(bearing: float, direction: Direction, **changes: Any) -> Array:
    trajectory = UnicycleTrajectory(bearing, SPEED, GAIN, direction)
    request: dict[str, Any] = WALK | {"first_foot": Foot.LEFT} | changes
    return place_footsteps(trajectory, **request)


@pytest.mark.parametrize("direction", Direction)
def test_straight_walk_matches_hand_computation(direction: Direction) -> None:
    """The right foot supports at the origin; the left lands ahead of it."""
    dx = 0.04 * direction.value
    expected = [[dx, 0.1, 0.0], [2 * dx, 0.0, 0.0], [3 * dx, 0.1, 0.0]]
    np.testing.assert_allclose(
        place(0.0, direction, count=3), expected, atol=1e-15
    )


@given(st.floats(-3.1, 3.1), st.sampled_from(Direction), st.sampled_from(Foot))
def test_mirrored_bearing_mirrors_the_footsteps(
    bearing: float, direction: Direction, foot: Foot
) -> None:
    """Fails with (10) as printed, which bends every arc to one side."""
    one = place(bearing, direction, first_foot=foot)
    other = place(-bearing, direction, first_foot=foot.other)
    np.testing.assert_allclose(other * [1, -1, -1], one, atol=1e-12)


@given(st.floats(-3.1, 3.1), st.sampled_from(Direction))
def test_soles_stand_half_a_spacing_beside_the_path(
    bearing: float, direction: Direction
) -> None:
    x, y, theta = place(bearing, direction).T
    times = 0.4 * np.arange(1, 21)  # stride / speed
    path = UnicycleTrajectory(bearing, SPEED, GAIN, direction).poses(times)
    dx, dy = x - path[:, 0], y - 0.05 - path[:, 1]
    forward = np.cos(theta) * dx + np.sin(theta) * dy
    leftward = np.cos(theta) * dy - np.sin(theta) * dx
    side = np.where(np.arange(20) % 2 == 0, 0.05, -0.05)
    np.testing.assert_allclose(forward, 0.0, atol=1e-12)
    np.testing.assert_allclose(leftward, side, atol=1e-12)
