"""Test planar poses by the laws of the group SE(2)."""

from math import pi, tau

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.core.poses import (
    Pose,
    Sector,
    arc,
    in_sectors,
    rotate,
    wrap_angle,
    wrap_angles,
)

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


def test_arc_has_the_radius_speed_over_turning_rate() -> None:
    here = Pose(1.0, 2.0, np.pi / 2)
    there = here.compose(Pose(*arc(0.2 * np.pi, 0.0, -0.1 * np.pi)))
    assert there.theta == pytest.approx(0.4 * np.pi)
    centre = here.compose(Pose(0.0, -2.0, 0.0))
    apart = np.hypot(there.x - centre.x, there.y - centre.y)
    assert apart == pytest.approx(2.0)
    back = there.compose(Pose(*arc(-0.2 * np.pi, 0.0, 0.1 * np.pi)))
    np.testing.assert_allclose(back, here, atol=1e-12)
    np.testing.assert_allclose(arc(1.0, 0.5, 0.0), (1.0, 0.5, 0.0))


def test_arcs_follow_one_another_as_their_sum() -> None:
    """Also sideways: along a circle, all parts of it compose."""
    half = Pose(*arc(0.3, -0.2, 0.7))
    np.testing.assert_allclose(half.compose(half), arc(0.6, -0.4, 1.4))
    many = arc(np.zeros(3), [0.1, 0.2, 0.3], np.zeros((4, 1)))
    assert many.shape == (4, 3, 3)
    np.testing.assert_allclose(rotate(1.0, 0.0, np.pi / 2), (0, 1), atol=1e-15)


def test_a_sector_is_around_its_middle_also_beyond_half_a_turn() -> None:
    sectors = (Sector(1.0, 0.2), Sector(pi, 0.1))
    angles = [1.1, 0.7, -1.0, pi - 0.05, -pi + 0.05, 1.0 + tau]
    inside = [True, False, False, True, True, True]
    assert in_sectors(sectors, angles).tolist() == inside
