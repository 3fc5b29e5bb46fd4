"""Extent of a room, for views that show all of it."""

import numpy as np

from ..arena import Room
from ..core.poses import Array


def wall_corners(room: Room | None) -> Array:
    """Return the corners of all walls of a room, in [m]. Shape (n, 2).

    Args:
        room: The room; None for an open floor, which has no walls.
    """
    walls = () if room is None else room.walls
    return np.concatenate([np.zeros((0, 2)), *(w.points for w in walls)])
