"""Test shells that are thinned for a page."""

import numpy as np
import pytest
import trimesh

from stepaside.report.mesh_simplification import MOST, TriangleMesh, thinned


def ball(fine: int) -> TriangleMesh:
    """A ball of radius 1."""
    mesh = trimesh.creation.icosphere(subdivisions=fine)
    return TriangleMesh(np.array(mesh.vertices), np.array(mesh.faces))


def test_a_small_shell_stays_as_it_is() -> None:
    small = ball(2)
    assert len(small.faces) <= MOST
    assert thinned(small) is small


@pytest.mark.parametrize("most", [100, MOST, 5000])
def test_a_large_shell_keeps_its_shape_with_few_triangles(most: int) -> None:
    large = ball(5)
    thin = thinned(large, most)
    assert most / 5 < len(thin.faces) <= most < len(large.faces)
    mesh = trimesh.Trimesh(*thin, process=False)
    far = np.linalg.norm(thin.corners, axis=1)
    assert far.max() <= 1.0 + 1e-9 and far.min() > 1.0 - 5.0 / most**0.5
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(4.19, rel=6.0 / most**0.5)


def test_every_corner_lies_near_the_thinned_shell() -> None:
    """None is farther than the diagonal of a cell from a corner that stays."""
    large = ball(4)
    thin = thinned(large)
    away = np.linalg.norm(
        large.corners[:, None] - thin.corners[None], axis=2
    ).min(axis=1)
    assert away.max() < 0.3
