"""How much floor a player needs for the way that it took."""

from math import pi

import numpy as np

from ..core.convex import convex_hull, signed_area
from ..core.poses import Array


def floor_used(places: Array, radius: float) -> float:
    """Area of the least convex floor on which a disc can go a way.

    Args:
        places: Where its centre was, (x, y), in [m]. Shape (n, 2).
        radius: Of the disc, in [m].

    Returns:
        Area of the convex hull of the way, grown by the radius, in [m^2].
    """
    ring = convex_hull(np.asarray(places, dtype=np.float64))
    around = float(np.hypot(*(np.roll(ring, -1, axis=0) - ring).T).sum())
    return signed_area(ring) + around * radius + pi * radius**2
