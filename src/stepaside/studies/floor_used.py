"""Floor area that a player needs for its path."""

from math import pi

import numpy as np

from ..core.convex import convex_hull, signed_area
from ..core.poses import Array


def floor_used(positions: Array, radius: float) -> float:
    """Return the area of the smallest convex floor for the path of a disc.

    Args:
        positions: Positions (x, y) of its centre, in [m]. Shape (n, 2).
        radius: Radius of the disc, in [m].

    Returns:
        Area of the convex hull of the path, grown by the radius, in [m^2].
    """
    hull = convex_hull(np.asarray(positions, dtype=np.float64))
    perimeter = float(np.hypot(*(np.roll(hull, -1, axis=0) - hull).T).sum())
    return signed_area(hull) + perimeter * radius + pi * radius**2
