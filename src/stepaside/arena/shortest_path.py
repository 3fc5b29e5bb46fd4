"""Shortest path of a disc around obstacles, by a visibility graph."""

from functools import lru_cache
from math import atan2, ceil, cos, hypot, inf, isnan, nan, pi, sin, tau
from typing import Any

import numpy as np

from ..core.compilation import compiled, inlined
from ..core.convex import next_corners
from ..core.poses import Array, Pose
from .obstacles import (
    ObstacleSet,
    PackedObstacles,
    hull_clearance,
    segment_clearance,
)

ARC = pi / 8  # of a corner that one edge of a path goes around, in [rad]
SIDE_PREFERENCE = 0.4  # by which the other side must be shorter, in [m]
MARGIN = 0.01  # added to the radius at corners, in [m]
DETOUR = 1e-3  # angle between end and first waypoint of a detour, in [rad]
Point = tuple[float, float]


@inlined
def keeps_clear(
    packed: PackedObstacles,
    allowed: Any,
    x: float,
    y: float,
    u: float,
    v: float,
) -> bool:
    """Return whether a segment keeps a distance [m] from each hull."""
    for k in range(len(allowed)):
        clear = segment_clearance(packed, k, (x, y), (u, v), allowed[k])
        if clear < allowed[k]:
            return False
    return True


@inlined
def nearer(
    packed: PackedObstacles,
    k: int,
    ends: tuple[float, float, float, float],
    radius: float,
) -> float:
    """Return the radius [m], or less if a path begins or ends nearer."""
    near = hull_clearance(packed, k, ends[0], ends[1], radius + 1e-9)
    return hull_clearance(packed, k, ends[2], ends[3], near) - 1e-9


@compiled
def find_waypoint(
    packed: PackedObstacles,
    corners: Any,
    ends: tuple[float, float, float, float],
    radius: float,
    side: int,
) -> tuple[float, float]:
    """Return the first waypoint of a path (x, y, u, v); NaN without a path.

    See :func:`first_waypoint`.
    """
    x, y, u, v = ends
    count, hulls = len(corners), len(packed.circles)
    free = True
    for k in range(hulls):
        enough = radius
        if (
            free
            and segment_clearance(packed, k, (x, y), (u, v), enough) < enough
        ):
            enough = nearer(packed, k, ends, radius)
            clear = segment_clearance(packed, k, (x, y), (u, v), enough)
            free = clear >= enough
    if free:
        return u, v
    allowed = np.empty(hulls)
    for k in range(hulls):
        allowed[k] = nearer(packed, k, ends, radius)
    best, to_end = np.full(count, inf), np.full(count, inf)
    rest = np.empty(count)  # at least, in [m]
    first, visited = np.arange(count), np.zeros(count, dtype=np.bool_)
    total, last = inf, -1
    for n in range(count):
        a, b = corners[n, 0], corners[n, 1]
        rest[n] = hypot(a - u, b - v)
        if keeps_clear(packed, allowed, u, v, a, b):
            to_end[n] = rest[n]
        if keeps_clear(packed, allowed, x, y, a, b):
            left = (u - x) * (b - y) - (v - y) * (a - x)
            aside = SIDE_PREFERENCE if side * left < 0.0 else 0.0
            best[n] = hypot(a - x, b - y) + aside
        if best[n] + to_end[n] < total:
            total, last = best[n] + to_end[n], n
    margin = np.full(hulls, radius)
    for _ in range(count):
        number, ahead = -1, total
        for n in range(count):
            if not visited[n] and best[n] + rest[n] < ahead:
                number, ahead = n, best[n] + rest[n]
        if number < 0:
            break
        visited[number] = True
        a, b = corners[number, 0], corners[number, 1]
        for n in range(count):
            c, d = corners[n, 0], corners[n, 1]
            through = best[number] + hypot(c - a, d - b)
            if visited[n] or not through < best[n] - 1e-12:
                continue
            if through + rest[n] < total and keeps_clear(
                packed, margin, a, b, c, d
            ):
                first[n], best[n] = first[number], through
                if through + to_end[n] < total:
                    total, last = through + to_end[n], n
    if last < 0:
        return nan, nan
    return corners[first[last], 0], corners[first[last], 1]


def first_waypoint(
    solids: ObstacleSet,
    start: Point,
    end: Point,
    radius: float,
    side: int = 0,
) -> Point | None:
    """Return the first waypoint of the shortest path of a disc to a point.

    Edges between corners pass each solid at the radius plus 1 cm, or nearer if
    start or end is. Corners form a visibility graph, searched by A*; only
    edges that could shorten the path are tested. Of both ways around, the side
    (left 1, right -1) is taken unless the other is 0.4 m shorter. The result
    is the end if the straight line is free, and None if there is no path.
    """
    corners = path_corners(solids, radius)
    ends = float(start[0]), float(start[1]), float(end[0]), float(end[1])
    x, y = find_waypoint(solids.packed, corners, ends, float(radius), side)
    return None if isnan(x) else (x, y)


@compiled
def find_course(
    packed: PackedObstacles,
    corners: Any,
    own: tuple[float, float, float, float],
    end: Point,
    radius: float,
    side: int,
    ahead: float,
) -> tuple[float, int, bool]:
    """Return bearing [rad] and side of the path, and whether it bends soon.

    The own position has the cosine and sine of the heading beside it. The side
    (left 1, right -1) is 0 if the end is straight ahead or there is no path.
    It bends soon on a detour, or if a way straight ahead, in [m], is blocked.
    """
    x, y, c, s = own
    u, v = find_waypoint(packed, corners, (x, y, end[0], end[1]), radius, side)
    dx, dy = end[0] - x, end[1] - y
    bearing = atan2(c * dy - s * dx, c * dx + s * dy)
    side = 0
    if not isnan(u):
        du, dv = u - x, v - y
        aside = atan2(dx * dv - dy * du, dx * du + dy * dv)
        if abs(aside) > DETOUR:
            side = 1 if aside > 0.0 else -1
            return atan2(c * dv - s * du, c * du + s * dv), side, True
    for k in range(len(packed.circles)):
        after = hull_clearance(packed, k, x + ahead * c, y + ahead * s, radius)
        if after < radius and after < (
            hull_clearance(packed, k, x, y, radius + 1e-9) - 1e-9
        ):
            return bearing, side, True
    return bearing, side, False


def course_around(
    solids: ObstacleSet,
    pose: Pose,
    end: Point,
    radius: float,
    side: int = 0,
    ahead: float = 0.0,
) -> tuple[float, int, bool]:
    """Return the course of a disc from a pose; see :func:`find_course`."""
    x, y, theta = pose
    own, corners = (x, y, cos(theta), sin(theta)), path_corners(solids, radius)
    return find_course(
        *(solids.packed, corners, own, end), float(radius), side, ahead
    )


@lru_cache(maxsize=16)
def path_corners(solids: ObstacleSet, radius: float) -> Array:
    """Return the corners (n, 2) of paths of a disc that keep clear of all.

    Each corner of a solid is passed along a polygonal chain around the arc
    from the normal of one edge to that of the next, a disc all around.
    """
    chains = [np.zeros((0, 2))]
    for solid in solids:
        ways = next_corners(solid.points) - solid.points
        normals = np.arctan2(-ways[:, 0], ways[:, 1])
        before = np.roll(normals, 1)
        turns = (normals - before) % tau if len(ways) > 1 else (tau,)
        for point, start, turn in zip(
            solid.points, before, turns, strict=True
        ):
            count = max(1, ceil(turn / ARC - 1e-9))
            half = 0.5 * turn / count
            out = (solid.rounding + radius + MARGIN) / cos(half)
            angles = start + half * (2.0 * np.arange(count) + 1.0)
            chain = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
            chains.append(point + out * chain)
    corners: Array = np.concatenate(chains)
    return corners[solids.segments_keep_clear(radius, corners, corners)]
