"""Test hulls, half planes and areas of convex polygons."""

import numpy as np
import pytest

from stepaside.core.convex import convex_hull, half_planes, signed_area

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


@pytest.mark.parametrize("seed", range(5))
def test_a_hull_is_convex_and_holds_all_points(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(40, 2))
    corners = convex_hull(points)
    edges = np.roll(corners, -1, axis=0) - corners
    after = np.roll(edges, -1, axis=0)
    assert (edges[:, 0] * after[:, 1] > edges[:, 1] * after[:, 0]).all()
    normals, offsets = half_planes(corners)
    assert (points @ normals.T - offsets).max() < 1e-12
    np.testing.assert_array_equal(convex_hull(corners), corners)


def test_points_on_an_edge_and_points_twice_are_no_corners() -> None:
    points = np.concatenate([SQUARE, SQUARE, [[1.0, 0.0], [2.0, 1.0]]])
    np.testing.assert_array_equal(convex_hull(points), SQUARE)


def test_a_tolerance_leaves_out_corners_that_are_nearly_straight() -> None:
    near = np.concatenate([SQUARE, [[1.0, -1e-9]]])
    assert len(convex_hull(near)) == 5
    np.testing.assert_array_equal(convex_hull(near, 1e-8), SQUARE)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_the_hull_of_points_on_a_line_is_its_ends(count: int) -> None:
    points = np.linspace(0.0, 1.0, count)[:, None] * [3.0, 4.0]
    expected = points[[0, -1]] if count > 1 else points
    np.testing.assert_array_equal(convex_hull(points[::-1]), expected)


def test_the_area_of_a_square_changes_sign_with_its_sense() -> None:
    assert signed_area(SQUARE) == 4.0
    assert signed_area(SQUARE[::-1]) == -4.0
