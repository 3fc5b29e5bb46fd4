"""Existence of a collision-free path of a disc between two points."""

from math import ceil

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from .room import Room

CELL = 0.02  # of the grid on which paths are searched, in [m]
MOST_CELLS = 4_000_000
Cells = NDArray[np.bool_]


def path_exists(
    room: Room,
    start: tuple[float, float],
    end: tuple[float, float],
    radius: float,
) -> bool:
    """Return whether a disc can move from one point to another.

    The search runs on a grid: a path through a gap that is wider than the
    disc by less than about a cell, 2 cm, may be missed.

    Args:
        room: The room.
        start: Start point (x, y) in the room, in [m].
        end: End point (x, y) in the room, in [m].
        radius: Radius of the disc, in [m].
    """
    if _straight(room, start, end, radius):
        return True
    low, high = _extent(room, np.array([start, end]), radius)
    cell = max(CELL, float(np.sqrt(np.prod(high - low) / MOST_CELLS)))
    counts = [ceil(side / cell) + 1 for side in (high - low).tolist()]
    x = low[0] + cell * np.arange(counts[0])
    y = low[1] + cell * np.arange(counts[1])
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    free = room.clearance(grid.reshape(-1, 2)) >= radius - 1e-9
    reached = np.zeros(counts, dtype=np.bool_)
    free = free.reshape(counts)
    first, last = (
        tuple(np.rint((np.array(point) - low) / cell).astype(int).tolist())
        for point in (start, end)
    )
    reached[first] = free[first] = free[last] = True
    while not reached[last]:
        before = int(reached.sum())
        # Flood whole rows at once: few sweeps suffice even around corners.
        for axis in (0, 1):
            reached = _flood_rows(reached, free, axis)
        if int(reached.sum()) == before:
            return False
    return True


def _flood_rows(reached: Cells, free: Cells, axis: int) -> Cells:
    """Extend reached cells along an axis up to the next occupied cells."""
    reached = np.moveaxis(reached, axis, 1)
    free = np.moveaxis(free, axis, 1)
    walls = np.cumsum(~free, axis=1)
    # Free cells of one run share the number of occupied cells before them.
    runs = walls + np.arange(len(walls))[:, None] * (walls.shape[1] + 1)
    run_reached = np.zeros(int(runs.max()) + 1, dtype=np.bool_)
    run_reached[runs[reached & free]] = True
    flooded: Cells = np.moveaxis(run_reached[runs] & free, 1, axis)
    return flooded


def _straight(
    room: Room,
    start: tuple[float, float],
    end: tuple[float, float],
    radius: float,
) -> bool:
    """Return whether the straight line between both is certainly free."""
    along = np.subtract(end, start)
    count = ceil(float(np.hypot(*along)) / CELL) + 1
    fraction = np.linspace(0.0, 1.0, count)[:, None]
    clearance = room.clearance(np.array(start) + fraction * along)
    # Clearance is 1-Lipschitz: between samples it falls by half a cell.
    return bool(clearance.min() >= radius + 0.5 * CELL)


def _extent(room: Room, points: Array, radius: float) -> tuple[Array, Array]:
    """Return corners of an area that contains a path if there is any."""
    if room.is_closed:
        half = 0.5 * np.array([room.width, room.depth], dtype=np.float64)
        return -half, half
    for solid in room.solids:
        corners, reach = solid.points, solid.hull.radius
        points = np.concatenate([points, corners - reach, corners + reach])
    margin = 2.0 * radius + CELL  # room to pass around all obstacles
    return points.min(axis=0) - margin, points.max(axis=0) + margin
