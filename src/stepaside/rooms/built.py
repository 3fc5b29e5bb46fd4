"""Boxes, walls and hulls: polygons by other words."""

from math import cos, hypot, sin

import numpy as np
from numpy.typing import ArrayLike

from ..errors import check_bearing, check_within
from .outline import ERROR, FARTHEST, SMALLEST, check_coordinate
from .shapes import Polygon

WALL = 0.1  # thickness of a wall, in [m]


def box(
    x: float, y: float, width: float, depth: float, heading: float = 0.0
) -> Polygon:
    """A box around a centre.

    Args:
        x: Of its centre, in [m].
        y: Of its centre, in [m].
        width: Along its heading, in [m].
        depth: Across its heading, in [m].
        heading: Of its width, in [rad].

    Raises:
        ConfigurationError: If a value is out of its range.
    """
    check_coordinate(x, "box x")
    check_coordinate(y, "box y")
    check_within(width, SMALLEST, FARTHEST, "box width", "m", ERROR)
    check_within(depth, SMALLEST, FARTHEST, "box depth", "m", ERROR)
    check_bearing(heading, "box heading", ERROR)
    c, s = cos(heading), sin(heading)
    corners = []
    for along, across in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        u, v = 0.5 * along * width, 0.5 * across * depth
        corners.append((x + c * u - s * v, y + s * u + c * v))
    return Polygon(tuple(corners))


def wall_between(
    start: tuple[float, float],
    end: tuple[float, float],
    thickness: float = WALL,
) -> Polygon:
    """A wall whose middle runs from one point to another.

    Args:
        start: Where it begins, (x, y), in [m].
        end: Where it ends, likewise.
        thickness: In [m].

    Raises:
        ConfigurationError: If a value is out of its range.
    """
    for name, (x, y) in (("start", start), ("end", end)):
        check_coordinate(x, f"wall {name} x")
        check_coordinate(y, f"wall {name} y")
    check_within(thickness, SMALLEST, FARTHEST, "wall thickness", "m", ERROR)
    along = np.subtract(end, start)
    length = hypot(*along)
    check_within(length, SMALLEST, FARTHEST, "wall length", "m", ERROR)
    heading = float(np.arctan2(along[1], along[0]))
    x, y = 0.5 * np.add(start, end)
    return box(float(x), float(y), length, thickness, heading)


def hull(points: ArrayLike) -> Polygon:
    """The least convex polygon that holds all of some points.

    Args:
        points: Points (x, y), in [m]. Shape (n, 2).

    Raises:
        ConfigurationError: If they all lie on a line.
    """
    unique = np.unique(np.asarray(points, dtype=np.float64), axis=0).tolist()
    half: list[list[list[float]]] = []
    for ordered in (unique, unique[::-1]):
        chain: list[list[float]] = []
        for x, y in ordered:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (y - by) > (by - ay) * (x - bx) + 1e-12:
                    break
                chain.pop()
            chain.append([x, y])
        half.append(chain[:-1])
    return Polygon(tuple((x, y) for x, y in half[0] + half[1]))
