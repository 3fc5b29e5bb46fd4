"""Free space of a room: paths of a disc, initial poses, areas and gaps."""

from itertools import combinations
from math import ceil
from typing import Any

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from .obstacles import clearance_between
from .room import Room
from .room_file import room_to_entries

BODY_RADIUS = 0.20  # of a player among obstacles, in [m]
PLAYERS = ("pursuer", "evader")
CELL = 0.02  # of the grid for paths and areas, in [m]
MOST_CELLS = 4_000_000


def path_exists(
    room: Room,
    start: tuple[float, float],
    end: tuple[float, float],
    radius: float,
) -> bool:
    """Return whether a disc can move from one point to another, in [m].

    A path through a gap that is at most 2 cm wider than it may be missed.
    """
    ends, solids = np.array([start, end]), room.solid_set
    keep = np.full(len(solids), radius)
    if solids.segments_keep_clear(keep, ends[:1], ends[1:])[0]:
        return True
    from scipy.ndimage import label

    low, high = _extent(room, ends, radius)
    cell = max(CELL, float(np.sqrt(np.prod(high - low) / MOST_CELLS)))
    counts = [ceil(side / cell) + 1 for side in (high - low).tolist()]
    x = low[0] + cell * np.arange(counts[0])
    y = low[1] + cell * np.arange(counts[1])
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    free = room.clearance(grid.reshape(-1, 2)) >= radius - 1e-9
    free = free.reshape(counts)
    first, last = (
        tuple(np.rint((np.array(point) - low) / cell).astype(int).tolist())
        for point in (start, end)
    )
    free[first] = free[last] = True
    areas, _ = label(free)
    return bool(areas[first] == areas[last])


def _extent(room: Room, points: Array, radius: float) -> tuple[Array, Array]:
    """Return corners of an area that contains a path if there is any."""
    if room.is_closed:
        half = 0.5 * np.array([room.width, room.depth], dtype=np.float64)
        return -half, half
    for solid in room.solids:
        corners, reach = solid.points, solid.rounding
        points = np.concatenate([points, corners - reach, corners + reach])
    margin = 2.0 * radius + CELL  # room to pass around all obstacles
    return points.min(axis=0) - margin, points.max(axis=0) + margin


def check_initial_poses(room: Room, starts: tuple[Pose, Pose]) -> None:
    """Check that initial poses of both are free and connected by a path."""
    radius = BODY_RADIUS
    for name, pose in zip(PLAYERS, starts, strict=True):
        place = f"({pose.x:g}, {pose.y:g})"
        clearance = float(room.clearance([pose[:2]])[0])
        for moving in room.moving:
            gap = float(moving.at(0.0).clearance([pose[:2]])[0])
            clearance = min(clearance, gap)
        if room.is_closed and not room.is_inside([pose[:2]])[0]:
            raise ConfigurationError(
                f"the {name} must start between the walls, within "
                f"{room.width:g} x {room.depth:g} [m], got {place}"
            )
        if not clearance >= radius - 1e-9:
            raise ConfigurationError(
                f"the {name} must start at least {radius:g} [m] from "
                f"obstacles and walls, got {clearance:.3g} at {place}"
            )
    distance = float(np.hypot(*np.subtract(starts[0][:2], starts[1][:2])))
    if distance < 2.0 * radius - 1e-9:
        raise ConfigurationError(
            f"the players must start at least {2 * radius:g} [m] apart, "
            f"got {distance:.3g}"
        )
    if not path_exists(room, starts[0][:2], starts[1][:2], radius):
        raise ConfigurationError(
            f"a path at least {2 * radius:g} [m] wide must connect the "
            "initial poses of pursuer and evader, got a room without one"
        )


def measure_room(room: Room) -> dict[str, Any]:
    """Measure a room, as a JSON object: obstacles, gaps, areas, entries."""
    result: dict[str, Any] = {
        "obstacles": len(room.obstacles),
        "doors": len(room.doors),
        "closed": room.is_closed,
        "narrowest_gap_m": _narrowest_gap(room),
    }
    if room.width is not None and room.depth is not None:
        sides = [
            (np.arange(round(side / CELL)) + 0.5) * CELL - 0.5 * side
            for side in (room.width, room.depth)
        ]
        grid = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
        clearance = room.clearance(grid)
        floor = room.width * room.depth
        result["floor_m2"] = floor
        result["free_m2"] = floor * float((clearance > 0.0).mean())
        result["body_radius_m"] = BODY_RADIUS
        result["free_for_body_m2"] = floor * float(
            (clearance > BODY_RADIUS).mean()
        )
    result["room"] = room_to_entries(room)
    return result


def _narrowest_gap(room: Room) -> float | None:
    """Return the least distance of two solids that do not touch, in [m]."""
    gaps = (clearance_between(*pair) for pair in combinations(room.solids, 2))
    return min((gap for gap in gaps if gap > 1e-6), default=None)
