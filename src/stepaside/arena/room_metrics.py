"""Areas, gaps and counts of a room."""

from itertools import combinations
from typing import Any

import numpy as np

from .initial_pose_checks import BODY_RADIUS
from .obstacles import clearance_between
from .room import Room
from .room_file import room_to_entries

CELL = 0.02  # of the grid that measures areas, in [m]


def measure_room(room: Room, radius: float = BODY_RADIUS) -> dict[str, Any]:
    """Measure a room, as a JSON object.

    Args:
        room: The room.
        radius: Radius of a body in the room, in [m].

    Returns:
        Numbers of obstacles and doors, narrowest gap between solids [m],
        areas [m^2] of the floor, of the free floor and of the positions of
        the centre of a body, and the entries of the room's file.
    """
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
        result["body_radius_m"] = radius
        result["free_for_body_m2"] = floor * float((clearance > radius).mean())
    result["room"] = room_to_entries(room)
    return result


def _narrowest_gap(room: Room) -> float | None:
    """Return the least distance of two solids that do not touch, in [m]."""
    gaps = (clearance_between(*pair) for pair in combinations(room.solids, 2))
    return min((gap for gap in gaps if gap > 1e-6), default=None)
