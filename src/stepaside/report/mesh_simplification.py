"""Meshes of a model, small enough to be sent to a page once.

Vendors publish shells of some hundred thousand triangles. What is drawn of
them is what is left when all corners in one cell of a grid become one.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array

MOST = 800  # triangles of one mesh on a page
COARSE, FINE = 2, 64  # cells along the longest side of a mesh


class TriangleMesh(NamedTuple):
    """A surface of triangles.

    Attributes:
        corners: In the frame of its geom, in [m]. Shape (corners, 3).
        faces: Three corners each. Shape (faces, 3).
    """

    corners: Array
    faces: NDArray[np.int64]


def shell_of(model: mujoco.MjModel, geom: int) -> TriangleMesh:
    """Surface of a mesh geom, as fine as a page can bear."""
    mesh = int(model.geom_dataid[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    corners = model.mesh_vert[first : first + count].astype(np.float64)
    first, count = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    faces = model.mesh_face[first : first + count].astype(np.int64)
    return thinned(TriangleMesh(corners, faces))


def thinned(shell: TriangleMesh, most: int = MOST) -> TriangleMesh:
    """The finest shell of at most some triangles.

    Args:
        shell: Any; it is left as it is if it has no more.
        most: Greatest number of triangles.

    Returns:
        Corners that lie in one cell of a grid are their mean, and triangles
        that are a line then are gone.
    """
    cells = FINE
    thin = shell
    while len(thin.faces) > most and cells >= COARSE:
        thin = _clustered(shell, cells)
        cells = int(cells / 1.3)
    return thin


def _clustered(shell: TriangleMesh, cells: int) -> TriangleMesh:
    """Shell whose corners are the means of those in a cell of a grid."""
    low = shell.corners.min(axis=0)
    side = float((shell.corners.max(axis=0) - low).max()) / cells
    at = np.floor((shell.corners - low) / max(side, 1e-9)).astype(np.int64)
    _, cell, counts = np.unique(
        at @ np.array([1, 1 << 20, 1 << 40]),
        return_inverse=True,
        return_counts=True,
    )
    corners = np.zeros((len(counts), 3))
    np.add.at(corners, cell, shell.corners)
    corners /= counts[:, None]
    faces = cell[shell.faces]
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    _, kept = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return TriangleMesh(corners, faces[np.sort(kept)])
