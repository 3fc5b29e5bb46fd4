"""Shortest path of a disc around obstacles, by a visibility graph."""

from functools import lru_cache
from math import ceil, cos, pi, tau

import numpy as np

from ..core.convex import next_corners
from ..core.poses import Array
from .obstacles import ObstacleSet

ARC = pi / 8  # of a corner that one edge of a path goes around, in [rad]
SIDE_PREFERENCE = 0.4  # by which the other side must be shorter, in [m]
MARGIN = 0.01  # added to the radius at corners, in [m]
Point = tuple[float, float]


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
    ends = np.array([start, end])
    clear = solids.clearances(ends).min(axis=0)
    allowed = np.minimum(radius, clear - 1e-9)
    if solids.segments_keep_clear(allowed, ends[:1], ends[1:])[0]:
        return end
    corners = path_corners(solids, radius)
    from_start, to_end = (
        np.where(
            solids.segments_keep_clear(allowed, point[None], corners),
            np.hypot(*(corners - point).T),
            np.inf,
        )
        for point in ends
    )
    if np.isinf(to_end).all():
        return None
    (x, y), (u, v) = start, end
    left = (u - x) * (corners[:, 1] - y) - (v - y) * (corners[:, 0] - x)
    best = from_start + np.where(side * left < 0.0, SIDE_PREFERENCE, 0.0)
    rest = np.hypot(*(corners - ends[1]).T)  # at least, in [m]
    first = np.arange(len(corners))
    visited = np.zeros(len(corners), dtype=np.bool_)
    for _ in range(len(corners)):
        ahead = np.where(visited, np.inf, best + rest)
        number = int(ahead.argmin())
        total = (best + to_end).min()
        if not ahead[number] < total:
            break
        visited[number] = True
        corner = corners[number]
        through = best[number] + np.hypot(*(corners - corner).T)
        shorter = (through < best - 1e-12) & (through + rest < total)
        (after,) = np.nonzero(shorter & ~visited)
        after = after[
            solids.segments_keep_clear(radius, corner[None], corners[after])
        ]
        first[after], best[after] = first[number], through[after]
    total = best + to_end
    if np.isinf(total).all():
        return None
    x, y = corners[first[int(total.argmin())]].tolist()
    return x, y


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
