"""Whether a body comes from one place to another."""

from math import ceil

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from .room import Room

CELL = 0.02  # of the grid on which ways are sought, in [m]
MOST = 4_000_000  # cells
Cells = NDArray[np.bool_]


def has_way(
    room: Room,
    start: tuple[float, float],
    end: tuple[float, float],
    radius: float,
) -> bool:
    """Whether a disc can move from one point to another.

    On a grid: a way through a gap that is less than about a cell, 2 cm,
    wider than the disc may be missed.

    Args:
        room: The room.
        start: Where it begins, (x, y), in [m].
        end: Where it ends, likewise.
        radius: Of the disc, in [m].
    """
    if _straight(room, start, end, radius):
        return True
    low, high = _extent(room, np.array([start, end]), radius)
    cell = max(CELL, float(np.sqrt(np.prod(high - low) / MOST)))
    counts = [ceil(side / cell) + 1 for side in (high - low).tolist()]
    x = low[0] + cell * np.arange(counts[0])
    y = low[1] + cell * np.arange(counts[1])
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    free = room.clearance(grid.reshape(-1, 2)) >= radius - 1e-9
    there = np.zeros(counts, dtype=np.bool_)
    free = free.reshape(counts)
    first, last = (
        tuple(np.rint((np.array(place) - low) / cell).astype(int).tolist())
        for place in (start, end)
    )
    there[first] = free[first] = free[last] = True
    while not there[last]:
        before = int(there.sum())
        # Along whole rows at once: few sweeps even around corners.
        for axis in (0, 1):
            there = _swept(there, free, axis)
        if int(there.sum()) == before:
            return False
    return True


def _swept(there: Cells, free: Cells, axis: int) -> Cells:
    """All free cells that adjoin, along rows, those that are reached."""
    there, free = np.moveaxis(there, axis, 1), np.moveaxis(free, axis, 1)
    walls = np.cumsum(~free, axis=1)
    # A run of free cells of a row has one number of walls before it.
    runs = walls + np.arange(len(walls))[:, None] * (walls.shape[1] + 1)
    reached = np.zeros(int(runs.max()) + 1, dtype=np.bool_)
    reached[runs[there & free]] = True
    swept: Cells = np.moveaxis(reached[runs] & free, 1, axis)
    return swept


def _straight(
    room: Room,
    start: tuple[float, float],
    end: tuple[float, float],
    radius: float,
) -> bool:
    """Whether it can for sure move along the line between them."""
    along = np.subtract(end, start)
    count = ceil(float(np.hypot(*along)) / CELL) + 1
    share = np.linspace(0.0, 1.0, count)[:, None]
    clearance = room.clearance(np.array(start) + share * along)
    # Clearance changes as far as one walks, so half a sample at most.
    return bool(clearance.min() >= radius + 0.5 * CELL)


def _extent(room: Room, points: Array, radius: float) -> tuple[Array, Array]:
    """Corners of a floor on which there is a way if there is one at all."""
    if room.is_closed:
        half = 0.5 * np.array([room.width, room.depth], dtype=np.float64)
        return -half, half
    for solid in room.solids:
        corners, reach = solid.points, solid.hull.radius
        points = np.concatenate([points, corners - reach, corners + reach])
    beyond = 2.0 * radius + CELL  # all the way around everything
    return points.min(axis=0) - beyond, points.max(axis=0) + beyond
