"""Cover of grid cells by a few convex polygons."""

import numpy as np
from numpy.typing import NDArray

from ..arena import Polygon
from ..core.convex import Point, lower_hull, signed_area
from ..core.poses import Array

# Largest area of a hull over that of its cells; a diagonal line of cells
# has 2.
LOOSE = 2.2
Indices = NDArray[np.int64]


def cover(
    centres: Array, cell: float, loose: float = LOOSE
) -> tuple[Polygon, ...]:
    """Return convex polygons, in [m], whose union contains every cell.

    A set of cells that fills its hull poorly is split across its longer
    principal axis, at the widest gap if there is one: a corner of two walls
    becomes two polygons. ``loose`` is the largest ratio of the areas.
    """
    points = np.asarray(centres, dtype=np.float64)
    first = points.min(axis=0, initial=np.inf)
    cells = np.rint((points - first) / cell).astype(np.int64)
    polygons: list[Polygon] = []
    waiting = [np.arange(len(points))] if len(points) else []
    while waiting:
        chosen = waiting.pop()
        corners = np.array(_hull_of_cells(cells[chosen]))
        if len(chosen) < 2 or signed_area(corners) <= loose * len(chosen):
            around = np.round(first + cell * (corners - 0.5), 9).tolist()
            polygons.append(Polygon(tuple((x, y) for x, y in around)))
        else:
            parts = _split(points[chosen], cell)
            waiting += [chosen[part] for part in parts]
    return tuple(polygons)


def _hull_of_cells(cells: Indices) -> list[Point]:
    """Return the hull of cells; cell (i, j) is the square from (i, j) on.

    Only the lowest and the highest cell of a column can have a corner.
    """
    columns, rows = cells.T
    begin = int(columns.min())
    width = int(columns.max()) - begin + 2
    lowest = np.full(width, np.iinfo(np.int64).max)
    highest = np.full(width, -1)
    for side in (0, 1):
        np.minimum.at(lowest, columns - begin + side, rows)
        np.maximum.at(highest, columns - begin + side, rows + 1)
    present = highest >= 0
    x = (np.flatnonzero(present) + begin).tolist()
    low, high = lowest[present].tolist(), highest[present].tolist()
    upper = list(zip(x, high, strict=True))[::-1]
    return lower_hull(list(zip(x, low, strict=True))) + lower_hull(upper)


def _split(points: Array, cell: float) -> tuple[Indices, Indices]:
    """Split two or more cells with given centres; return their indices."""
    about = points - points.mean(axis=0)
    axis = np.linalg.eigh(about.T @ about)[1][:, -1]
    along = about @ axis
    order = np.argsort(along, kind="stable")
    gaps = np.diff(along[order])
    widest = int(gaps.argmax())
    if gaps[widest] < 2.0 * cell:
        widest = len(points) // 2 - 1
    return order[: widest + 1], order[widest + 1 :]
