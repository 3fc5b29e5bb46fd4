"""Simplification of meshes for pages."""

import numpy as np
import pytest
import trimesh

from stepaside.report.mesh_simplification import (
    MAX_TRIANGLES,
    TriangleMesh,
    simplify,
)


def ball(fine: int) -> TriangleMesh:
    """Return a sphere of radius 1 m."""
    mesh = trimesh.creation.icosphere(subdivisions=fine)
    return TriangleMesh(np.array(mesh.vertices), np.array(mesh.faces))


def test_a_small_mesh_is_unchanged() -> None:
    small = ball(2)
    assert len(small.faces) <= MAX_TRIANGLES
    assert simplify(small) is small


def test_a_large_mesh_keeps_its_shape_with_few_triangles() -> None:
    large, most = ball(5), MAX_TRIANGLES
    thin = simplify(large)
    assert most / 5 < len(thin.faces) <= most < len(large.faces)
    mesh = trimesh.Trimesh(*thin, process=False)
    far = np.linalg.norm(thin.vertices, axis=1)
    assert far.max() <= 1.0 + 1e-9 and far.min() > 1.0 - 5.0 / most**0.5
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(4.19, rel=6.0 / most**0.5)


def test_every_vertex_is_near_a_vertex_of_the_simplified_mesh() -> None:
    """None is farther than the diagonal of a cell from a corner that stays."""
    large = ball(4)
    thin = simplify(large)
    away = np.linalg.norm(
        large.vertices[:, None] - thin.vertices[None], axis=2
    ).min(axis=1)
    assert away.max() < 0.3
