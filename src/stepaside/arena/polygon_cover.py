"""Cover of grid cells by a few convex polygons."""

import numpy as np

from ..core.poses import Array
from .shapes import Polygon, hull

# Largest area of a hull over that of its cells; a diagonal line of cells
# has 2.
LOOSE = 2.2


def cover(
    centres: Array, cell: float, loose: float = LOOSE
) -> tuple[Polygon, ...]:
    """Cover cells of a grid with convex polygons.

    A set of cells that fills its hull poorly is split across its longer
    principal axis, at the widest gap if there is one: a corner of two walls
    becomes two polygons.

    Args:
        centres: Centres of the cells, in [m]. Shape (n, 2).
        cell: Side of a cell, along the axes, in [m].
        loose: Largest ratio of the area of a polygon to that of its cells.

    Returns:
        Polygons whose union contains every cell.
    """
    polygons: list[Polygon] = []
    waiting = [np.asarray(centres, dtype=np.float64)]
    signs = 0.5 * cell * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    while waiting:
        cells = waiting.pop()
        if not len(cells):
            continue
        corners = (cells[:, None, :] + signs).reshape(-1, 2)
        around = hull(np.round(corners, 9))
        if len(cells) < 2 or around.area <= loose * len(cells) * cell**2:
            polygons.append(around)
            continue
        waiting += _split(cells, cell)
    return tuple(polygons)


def _split(cells: Array, cell: float) -> list[Array]:
    """Split two or more cells into two sets."""
    about = cells - cells.mean(axis=0)
    axis = np.linalg.eigh(about.T @ about)[1][:, -1]
    along = about @ axis
    order = np.argsort(along, kind="stable")
    gaps = np.diff(along[order])
    widest = int(gaps.argmax())
    if gaps[widest] < 2.0 * cell:
        widest = len(cells) // 2 - 1
    return [cells[order[: widest + 1]], cells[order[widest + 1 :]]]
