"""Few convex polygons for many cells of a grid."""

import numpy as np

from ..core.poses import Array
from .shapes import Polygon, hull

LOOSE = 2.2  # area of a hull over that of its cells; 2 along a diagonal


def cover(
    centres: Array, cell: float, loose: float = LOOSE
) -> tuple[Polygon, ...]:
    """Cover cells of a grid with convex polygons.

    Cells that fill their hull badly are parted across their longer axis,
    in the widest gap if there is one: a corner of two walls becomes two.

    Args:
        centres: Of the cells, in [m]. Shape (n, 2).
        cell: Side of a cell, along the axes, in [m].
        loose: Area that a polygon may have over that of its cells.

    Returns:
        Polygons that together hold every cell.
    """
    found: list[Polygon] = []
    waiting = [np.asarray(centres, dtype=np.float64)]
    signs = 0.5 * cell * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    while waiting:
        cells = waiting.pop()
        if not len(cells):
            continue
        corners = (cells[:, None, :] + signs).reshape(-1, 2)
        around = hull(np.round(corners, 9))
        if len(cells) < 2 or around.area <= loose * len(cells) * cell**2:
            found.append(around)
            continue
        waiting += _parted(cells, cell)
    return tuple(found)


def _parted(cells: Array, cell: float) -> list[Array]:
    """Two parts of at least two cells."""
    about = cells - cells.mean(axis=0)
    axis = np.linalg.eigh(about.T @ about)[1][:, -1]
    along = about @ axis
    order = np.argsort(along, kind="stable")
    gaps = np.diff(along[order])
    widest = int(gaps.argmax())
    if gaps[widest] < 2.0 * cell:
        widest = len(cells) // 2 - 1
    return [cells[order[: widest + 1]], cells[order[widest + 1 :]]]
