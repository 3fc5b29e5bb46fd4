"""Convex polygons in the plane: hull, half planes and area."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]


def convex_hull(points: Array, tolerance: float = 0.0) -> Array:
    """Return the corners of the convex hull of points (n, 2). Shape (m, 2).

    Andrew's monotone chain: counter-clockwise from the smallest x; the two
    ends if all points lie on a line. Corners are dropped when the triangle
    with their two neighbours has at most half the tolerance as area.
    """
    ordered = sorted((x, y) for x, y in points.tolist())
    lower = lower_hull(ordered, tolerance)
    upper = lower_hull(ordered[::-1], tolerance)
    return np.array(lower[:-1] + upper[:-1] or ordered)


def lower_hull(
    ordered: Sequence[Point], tolerance: float = 0.0
) -> list[Point]:
    """Return the lower half of a convex hull of points in ascending order.

    In descending order they give the upper half.
    """
    hull: list[Point] = []
    for p in ordered:
        while len(hull) >= 2:
            (ax, ay), (bx, by) = hull[-2], hull[-1]
            turn = (by - ay) * (p[0] - ax) + tolerance
            if (bx - ax) * (p[1] - ay) > turn:
                break
            hull.pop()
        hull.append(p)
    return hull


def next_corners(polygon: Array) -> Array:
    """Return the corner after each corner of a polygon. Shape (n, 2)."""
    return np.concatenate([polygon[1:], polygon[:1]])


def half_planes(polygon: Array) -> tuple[Array, Array]:
    """Return the half planes whose intersection is a convex polygon.

    Corners are counter-clockwise. Shape (n, 2). Of unit normals a that point
    outwards and offsets b in [m], b - a p is the distance of a point p inside
    from an edge. Shapes (n, 2), (n,).
    """
    edges = next_corners(polygon) - polygon
    normals = np.column_stack([edges[:, 1], -edges[:, 0]])
    normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
    offsets: Array = (normals * polygon).sum(axis=1)
    return normals, offsets


def signed_area(polygon: Array) -> float:
    """Return the area of a polygon (n, 2), negative if clockwise, in [m^2]."""
    after = next_corners(polygon)
    doubled = polygon[:, 0] * after[:, 1] - polygon[:, 1] * after[:, 0]
    return 0.5 * float(doubled.sum())
