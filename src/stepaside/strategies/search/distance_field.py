"""Distance from obstacles in compiled loops, from a field of lower bounds.

When a cell of the plane is first asked for, the obstacles that matter within
it are listed, and its clearance is bounded from below: it is that at the
centre less at most half the diagonal. Where the bound does not suffice, the
listed obstacles give the exact distance.
"""

from math import isnan, sqrt
from typing import Any, NamedTuple

import numpy as np

from ...arena.obstacles import (
    PackedObstacles,
    clearance_at,
    hull_clearance,
)
from ...core.compilation import inlined

CELL = 0.1  # side of a cell, in [m]; 0.05 and 0.2 take longer
LISTED = 12  # obstacles that a cell can list; with more all are measured


class DistanceField(NamedTuple):
    """Lower bounds of the clearance, and the obstacles near each cell."""

    packed: PackedObstacles  # all obstacles
    enough: float  # largest distance of interest [m]
    x: float  # least x of the cells in the frame of the obstacles [m]
    y: float  # least y, likewise
    # lower bound of the clearance in each cell [m]; NaN until it is asked for.
    # (columns, rows)
    bounds: Any
    # number of obstacles near each cell, -1 for more than 12, and their
    # indices. (columns, rows, 13)
    nearby: Any


@inlined
def distance_field(
    packed: PackedObstacles, enough: float, x: float, y: float, reach: float
) -> DistanceField:
    """Return a field around a point (x, y) that is filled when it is used.

    Farther away than the reach all obstacles are measured. All in [m].
    """
    side = 2 * int(reach / CELL + 1.0)
    return DistanceField(
        packed,
        enough,
        x - 0.5 * side * CELL,
        y - 0.5 * side * CELL,
        np.full((side, side), np.nan),
        np.empty((side, side, LISTED + 1), dtype=np.int64),
    )


@inlined
def bound_cell(field: DistanceField, i: int, j: int) -> None:
    """Bound the clearance in a cell, and list the obstacles near it."""
    x, y = field.x + (i + 0.5) * CELL, field.y + (j + 0.5) * CELL
    half = CELL * sqrt(0.5)
    limit = field.enough + half
    least, count = limit, 0
    for k in range(field.packed.circles.shape[0]):
        clear = hull_clearance(field.packed, k, x, y, limit)
        if clear < limit:
            least = min(least, clear)
            count += 1
            if count <= LISTED:
                field.nearby[i, j, count] = k
    field.bounds[i, j] = least - half
    field.nearby[i, j, 0] = -1 if count > LISTED else count


@inlined
def field_clearance(field: DistanceField, x: float, y: float) -> float:
    """Return the clearance of a point, as :func:`clearance_at`."""
    u, v = (x - field.x) / CELL, (y - field.y) / CELL
    columns, rows = field.bounds.shape
    if not (0.0 <= u < columns and 0.0 <= v < rows):
        return clearance_at(field.packed, x, y, field.enough)
    i, j = int(u), int(v)
    if field.bounds[i, j] >= field.enough:
        return field.enough
    if isnan(field.bounds[i, j]):
        bound_cell(field, i, j)
    nearest, count = field.enough, field.nearby[i, j, 0]
    if count < 0:
        return clearance_at(field.packed, x, y, nearest)
    for n in range(1, count + 1):
        k = field.nearby[i, j, n]
        nearest = hull_clearance(field.packed, k, x, y, nearest)
    return nearest
