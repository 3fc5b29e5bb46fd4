"""How much floor a player needs for the way that it took."""

from math import pi

import numpy as np

from ..poses import Array


def floor_used(places: Array, radius: float) -> float:
    """Area of the least convex floor on which a disc can go a way.

    Args:
        places: Where its centre was, (x, y), in [m]. Shape (n, 2).
        radius: Of the disc, in [m].

    Returns:
        Area of the convex hull of the way, grown by the radius, in [m^2].
    """
    ring = _hull(np.unique(np.asarray(places, dtype=np.float64), axis=0))
    after = np.roll(ring, -1, axis=0)
    area = 0.5 * float((ring[:, 0] * after[:, 1]).sum())
    area -= 0.5 * float((ring[:, 1] * after[:, 0]).sum())
    around = float(np.hypot(*(after - ring).T).sum())
    return area + around * radius + pi * radius**2


def _hull(places: Array) -> Array:
    """Corners of a convex hull, counter-clockwise; of a line both ends."""
    points = places.tolist()
    half: list[list[list[float]]] = []
    for ordered in (points, points[::-1]):
        chain: list[list[float]] = []
        for x, y in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (y - by) > (by - ay) * (x - bx):
                    break
                chain.pop()
            chain.append([x, y])
        half.append(chain)
    return np.array(half[0][:-1] + half[1][:-1] or points)
