"""Simplification of the meshes of a model for web pages.

Published robot models have meshes of some hundred thousand triangles. They
are reduced by vertex clustering: all vertices in one cell of a grid become
their mean.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array

MAX_TRIANGLES = 800  # of one mesh on a page
MIN_CELLS, MAX_CELLS = 2, 64  # along the longest side of a mesh


class TriangleMesh(NamedTuple):
    """Triangle mesh.

    Attributes:
        vertices: In the frame of its geom, in [m]. Shape (vertices, 3).
        faces: Three vertices each. Shape (faces, 3).
    """

    vertices: Array
    faces: NDArray[np.int64]


def mesh_of(model: mujoco.MjModel, geom: int) -> TriangleMesh:
    """Return the simplified mesh of a mesh geom.

    Args:
        model: Model.
        geom: Number of the geom.
    """
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    first, count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    faces = model.mesh_face[first : first + count].astype(np.int64)
    return simplify(TriangleMesh(vertices, faces))


def simplify(mesh: TriangleMesh) -> TriangleMesh:
    """Reduce a mesh by the finest vertex clustering that is small enough.

    Args:
        mesh: Mesh; it is returned unchanged if it is small enough.

    Returns:
        Mesh whose degenerate and duplicate triangles are removed.
    """
    cells = MAX_CELLS
    reduced = mesh
    while len(reduced.faces) > MAX_TRIANGLES and cells >= MIN_CELLS:
        reduced = _cluster_vertices(mesh, cells)
        cells = int(cells / 1.3)
    return reduced


def _cluster_vertices(mesh: TriangleMesh, cells: int) -> TriangleMesh:
    """Replace the vertices in each cell of a grid by their mean."""
    low = mesh.vertices.min(axis=0)
    side = float((mesh.vertices.max(axis=0) - low).max()) / cells
    at = np.floor((mesh.vertices - low) / max(side, 1e-9)).astype(np.int64)
    _, cell, counts = np.unique(
        at @ np.array([1, 1 << 20, 1 << 40]),
        return_inverse=True,
        return_counts=True,
    )
    vertices = np.zeros((len(counts), 3))
    np.add.at(vertices, cell, mesh.vertices)
    vertices /= counts[:, None]
    faces = cell[mesh.faces]
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    _, unique = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return TriangleMesh(vertices, faces[np.sort(unique)])
