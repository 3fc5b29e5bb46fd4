"""Shortest path of a disc around obstacles, by a visibility graph."""

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, cos, pi, tau

import numpy as np

from ..core.poses import Array
from .obstacles import Obstacle, obstacle_set

ARC = pi / 8  # of a corner that one edge of a path goes around, in [rad]
SIDE_PREFERENCE = 0.4  # by which the other side must be shorter, in [m]
MARGIN = 0.01  # added to the radius at corners, in [m]
Point = tuple[float, float]


def first_waypoint(
    solids: Sequence[Obstacle],
    start: Point,
    end: Point,
    radius: float,
    side: int = 0,
) -> Point:
    """Return the first waypoint of the shortest path of a disc to a point.

    Paths consist of straight edges between corners, which pass each solid at
    a distance of the radius plus 1 cm and turn by at most 22.5 degrees.
    The corners form a visibility graph; the search is Dijkstra's.

    Args:
        solids: Obstacles and walls.
        start: Position (x, y) of the disc, in [m].
        end: Goal (x, y), in [m].
        radius: Radius of the disc, in [m]; a solid nearer than that to start
            or end may be passed at that smaller distance.
        side: Preferred side of the line to the goal, left (1), right (-1) or
            none (0); the other side is taken if it is 0.4 m shorter.

    Returns:
        The goal if the straight line is free, or if there is no path; else
        the first corner of the shortest path.
    """
    known = tuple(solids)
    ends = np.array([start, end])
    around = obstacle_set(known)
    clear = around.clearances(ends).min(axis=0)
    allowed = np.minimum(radius, clear - 1e-9)
    if around.segments_keep_clear(allowed, ends[0], ends[1:])[0]:
        return end
    graph = _visibility_graph(known, radius)
    corners = graph.corners
    count = len(corners)
    from_start = graph.lengths_from(allowed, ends[0])
    (x, y), (u, v) = start, end
    left = (u - x) * (corners[:, 1] - y) - (v - y) * (corners[:, 0] - x)
    best = from_start + np.where(side * left < 0.0, SIDE_PREFERENCE, 0.0)
    to_end = graph.lengths_from(allowed, ends[1])
    first = np.arange(count)
    visited = np.zeros(count, dtype=np.bool_)
    for _ in range(count):
        number = int(np.where(visited, np.inf, best).argmin())
        # A corner beyond the best complete path cannot shorten it.
        if visited[number] or not best[number] < (best + to_end).min():
            break
        visited[number] = True
        through = best[number] + graph.lengths_between(number)
        shorter = through < best - 1e-12
        first = np.where(shorter, first[number], first)
        best = np.where(shorter, through, best)
    total = best + to_end
    if not count or not np.isfinite(total.min()):
        return end
    x, y = corners[first[int(total.argmin())]].tolist()
    return x, y


class _VisibilityGraph:
    """Corners around solids and the free segments between them.

    Attributes:
        corners: Corners, in [m]. Shape (n, 2).
    """

    def __init__(self, solids: tuple[Obstacle, ...], radius: float) -> None:
        """Find the corners for a disc of a radius, in [m]."""
        self._solids = obstacle_set(solids)
        corners = _corners(solids, radius)
        clear = self._solids.clearances(corners) >= radius
        self.corners: Array = corners[clear.all(axis=1)]
        self._allowed = np.full(len(solids), radius)
        self._between: dict[int, Array] = {}

    def lengths_between(self, number: int) -> Array:
        """Return the lengths of edges from a corner, in [m]. Shape (n,)."""
        if number not in self._between:
            corner = self.corners[number]
            self._between[number] = self.lengths_from(self._allowed, corner)
        return self._between[number]

    def lengths_from(self, allowed: Array, point: Array) -> Array:
        """Return the distances of visible corners; inf where hidden."""
        lengths: Array = np.where(
            self._solids.segments_keep_clear(allowed, point, self.corners),
            np.hypot(*(self.corners - point).T),
            np.inf,
        )
        return lengths


_visibility_graph = lru_cache(maxsize=16)(_VisibilityGraph)


def _corners(solids: tuple[Obstacle, ...], radius: float) -> Array:
    """Return the corners of paths around each solid, in [m]. Shape (n, 2)."""
    found = [np.zeros((0, 2))]
    for solid in solids:
        away = solid.hull.radius + radius + MARGIN
        after = np.arctan2(*solid.hull.normals.T[::-1])
        begins = np.roll(after, 1)
        turns = (after - begins) % tau if len(after) > 1 else [tau]
        for corner, begin, turn in zip(
            solid.points, begins, turns, strict=True
        ):
            found.append(corner + _arc(float(begin), float(turn), away))
    return np.concatenate(found)


def _arc(begin: float, turn: float, radius: float) -> Array:
    """Return corners of a polygonal chain around an arc. Shape (n, 2)."""
    count = max(1, ceil(turn / ARC - 1e-9))
    half = 0.5 * turn / count
    angles = begin + half * (2.0 * np.arange(count) + 1.0)
    out = radius / cos(half)
    chain: Array = out * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return chain
