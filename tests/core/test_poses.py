"""Test planar poses by the laws of the group SE(2)."""

from math import pi, tau

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.core.poses import Pose, wrap_angle, wrap_angles

NUMBERS = st.floats(-10.0, 10.0)
POSES = st.builds(Pose, NUMBERS, NUMBERS, NUMBERS)


@given(POSES, POSES, POSES)
def test_composition_is_associative(a: Pose, b: Pose, c: Pose) -> None:
    left = a.compose(b).compose(c)
    right = a.compose(b.compose(c))
    np.testing.assert_allclose(left, right, atol=1e-12)


@given(POSES)
def test_inverse_undoes_a_pose(a: Pose) -> None:
    for both in (a.compose(a.inverse()), a.inverse().compose(a)):
        np.testing.assert_allclose(both, (0.0, 0.0, 0.0), atol=1e-12)


@given(POSES, NUMBERS, NUMBERS)
def test_points_transform_like_poses(a: Pose, x: float, y: float) -> None:
    moved = a.transform_points([[x, y]])[0]
    np.testing.assert_allclose(moved, a.compose(Pose(x, y, 0.0))[:2])


@given(st.floats(-100.0, 100.0))
def test_wrapping_changes_an_angle_by_whole_turns(angle: float) -> None:
    for wrapped in (wrap_angle(angle), float(wrap_angles(angle))):
        assert -pi <= wrapped <= pi
        turns = (angle - wrapped) / tau
        assert abs(turns - round(turns)) < 1e-9


def test_headings_turn_counter_clockwise() -> None:
    """A mirrored plane satisfies the group laws too."""
    quarter = Pose(1.0, 2.0, pi / 2)
    assert quarter.compose(Pose(3.0, 0.5, 0.1)) == pytest.approx(
        (0.5, 5.0, pi / 2 + 0.1)
    )
    np.testing.assert_allclose(
        quarter.transform_points([[3.0, 0.5], [0.0, 0.0]]),
        [[0.5, 5.0], [1.0, 2.0]],
    )


def test_half_turns_wrap_to_minus_pi_in_arrays() -> None:
    np.testing.assert_array_equal(wrap_angles([pi, -pi, 3 * pi]), 3 * [-pi])
    assert abs(wrap_angle(pi)) == pi
    assert wrap_angle(1.5 * pi) == pytest.approx(-0.5 * pi)
    assert wrap_angle(-1.5 * pi) == pytest.approx(0.5 * pi)
