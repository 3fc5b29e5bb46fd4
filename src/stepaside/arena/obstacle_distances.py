"""Distances of points and segments from obstacles, in compiled loops."""

from math import inf, sqrt
from typing import Any, NamedTuple

from ..core.compilation import compiled, inlined


class PackedObstacles(NamedTuple):
    """Discs and convex polygons as arrays, for compiled loops."""

    # centre x, y and radius of a circle around each obstacle [m], (obstacles,
    # 3)
    circles: Any
    # index of the first edge of each obstacle, and the number of edges. A disc
    # has none: it is its circle, (obstacles + 1,)
    firsts: Any
    # edges of all polygons, concatenated: outward unit normal, offset [m],
    # first corner x, y [m], length [m], (m, 6)
    edges: Any


@inlined
def hull_clearance(
    packed: PackedObstacles, k: int, x: float, y: float, nearest: float
) -> float:
    """Return the clearance of a point from one hull, at most ``nearest``."""
    edges, firsts, circles = packed.edges, packed.firsts, packed.circles
    dx, dy = x - circles[k, 0], y - circles[k, 1]
    reach = nearest + circles[k, 2]
    square = dx * dx + dy * dy
    if reach <= 0.0 or square > reach * reach:
        return nearest
    if firsts[k] == firsts[k + 1]:
        disc: float = min(nearest, sqrt(square) - circles[k, 2])
        return disc
    beyond = -inf
    for i in range(firsts[k], firsts[k + 1]):
        height = edges[i, 0] * x + edges[i, 1] * y - edges[i, 2]
        if height > beyond:
            beyond = height
            if beyond >= nearest:
                return nearest
    if beyond > 0.0:
        square = inf
        for i in range(firsts[k], firsts[k + 1]):
            # The edge runs to the left of its normal.
            dx, dy = x - edges[i, 3], y - edges[i, 4]
            along = dy * edges[i, 0] - dx * edges[i, 1]
            along = min(max(along, 0.0), edges[i, 5])
            dx += along * edges[i, 1]
            dy -= along * edges[i, 0]
            square = min(square, dx * dx + dy * dy)
        beyond = sqrt(square)
    return min(nearest, beyond)


@inlined
def clearance_at(
    packed: PackedObstacles, x: float, y: float, enough: float
) -> float:
    """Return the clearance [m] of a point, at most ``enough``."""
    nearest = enough
    for k in range(packed.circles.shape[0]):
        nearest = hull_clearance(packed, k, x, y, nearest)
    return nearest


@inlined
def from_segment(
    x: float, y: float, u: float, v: float, dx: float, dy: float
) -> float:
    """Return the distance of a point from a segment at (u, v), in [m]."""
    x, y = x - u, y - v
    share = (dx * x + dy * y) / max(dx * dx + dy * dy, 1e-300)
    share = min(max(share, 0.0), 1.0)
    x, y = x - share * dx, y - share * dy
    return sqrt(x * x + y * y)


@inlined
def segment_clearance(
    packed: PackedObstacles, k: int, start: Any, end: Any, enough: float
) -> float:
    """Return the clearance of a segment from one hull, in [m].

    It is -inf if the segment crosses a polygon (Cyrus-Beck), and may be too
    small beyond ``enough``.
    """
    edges, firsts, circles = packed.edges, packed.firsts, packed.circles
    u, v = start[0], start[1]
    dx, dy = end[0] - u, end[1] - v
    x, y, radius = circles[k, 0], circles[k, 1], circles[k, 2]
    least: float = from_segment(x, y, u, v, dx, dy) - radius
    if firsts[k] == firsts[k + 1] or least > enough:
        return least
    least = hull_clearance(packed, k, u, v, inf)
    least = hull_clearance(packed, k, end[0], end[1], least)
    enters, leaves = 0.0, 1.0
    for i in range(firsts[k], firsts[k + 1]):
        away = from_segment(edges[i, 3], edges[i, 4], u, v, dx, dy)
        least = min(least, away)
        height = edges[i, 0] * u + edges[i, 1] * v - edges[i, 2]
        slope = edges[i, 0] * dx + edges[i, 1] * dy
        if abs(slope) < 1e-12:
            if height > 0.0:
                enters = inf
        elif slope < 0.0:
            enters = max(enters, -height / slope)
        else:
            leaves = min(leaves, -height / slope)
    return -inf if enters <= leaves else least


@compiled
def measure_points(packed: PackedObstacles, points: Any, out: Any) -> None:
    """Set the clearance of points from each hull. Shape (n, hulls)."""
    for n in range(out.shape[0]):
        for k in range(out.shape[1]):
            x, y = points[n, 0], points[n, 1]
            out[n, k] = hull_clearance(packed, k, x, y, inf)


@compiled
def measure_nearest(packed: PackedObstacles, points: Any, out: Any) -> None:
    """Set the clearance of points from the nearest hull. Shape (n,)."""
    for n in range(out.shape[0]):
        out[n] = clearance_at(packed, points[n, 0], points[n, 1], inf)


@compiled
def measure_segments(
    packed: PackedObstacles, starts: Any, ends: Any, enough: Any, out: Any
) -> None:
    """Set the clearance of segments from each hull. Shape (n, hulls)."""
    for n in range(out.shape[0]):
        start, end = starts[n], ends[n]
        for k in range(out.shape[1]):
            out[n, k] = segment_clearance(packed, k, start, end, enough[k])
