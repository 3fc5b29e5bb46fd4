"""What of a room has to be in a picture of all of it."""

import numpy as np

from ..arena import Room
from ..core.poses import Array


def wall_corners(plan: Room | None) -> Array:
    """Return the corners of all walls of a room, in [m]. Shape (n, 2).

    Args:
        plan: The room; None for an open floor, which has none.
    """
    walls = () if plan is None else plan.walls
    return np.concatenate([np.zeros((0, 2)), *(w.points for w in walls)])
