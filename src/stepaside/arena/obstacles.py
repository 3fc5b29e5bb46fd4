"""Obstacles on the floor: the base class of shapes, and sets of them."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from math import inf, sqrt, tau
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.compilation import compiled, inlined
from ..core.convex import half_planes, next_corners
from ..core.entries import read_entries
from ..core.errors import ConfigurationError
from ..core.poses import Array


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


@compiled
def touches(
    packed: PackedObstacles, x: float, y: float, radius: float
) -> bool:
    """Return whether a disc at a point touches an obstacle."""
    return clearance_at(packed, x, y, radius) < radius


@compiled
def stop_at(
    packed: PackedObstacles, start: Any, end: Any, radius: float
) -> tuple[float, float]:
    """Return where a disc is that moves to a point: it touches no obstacle.

    It stays where it is if it would.
    """
    if touches(packed, end[0], end[1], radius):
        return start[0], start[1]
    return end[0], end[1]


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
    for i in range(firsts[k], firsts[k + 1]):
        height = edges[i, 0] * u + edges[i, 1] * v - edges[i, 2]
        height += min(edges[i, 0] * dx + edges[i, 1] * dy, 0.0)
        if height > enough:
            return float(height)
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


DIRECTION_COUNT = 64  # uniform directions; the nearest is within 3 degrees
NUDGE = 1e-6  # of a point, which shows the gradient of a distance, in [m]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Obstacle(ABC):
    """Convex shape on the floor: the hull of points, grown by a radius."""

    kind: ClassVar[str]  # "disc", "box" or "polygon"

    @staticmethod
    def from_entries(entries: Mapping[str, Any]) -> "Obstacle":
        """Read the shape that has such entries."""
        names = {
            kind: {each.name for each in fields(kind)}
            for kind in Obstacle.__subclasses__()
        }
        for kind, own in names.items():
            if own.issuperset(entries):
                return read_entries(kind, entries)
        listed = "; ".join(", ".join(sorted(own)) for own in names.values())
        raise ConfigurationError(
            f"an obstacle must have the entries of one shape: {listed}; got "
            f"{', '.join(entries)}"
        )

    @property
    @abstractmethod
    def points(self) -> Array:
        """Corners, counter-clockwise, or the centre of a disc, in [m]."""

    @property
    def rounding(self) -> float:
        """Radius of a disc, in [m]; else 0."""
        return 0.0

    @property
    def centre(self) -> tuple[float, float]:
        """Mean of the points, which lies inside, (x, y), in [m]."""
        x, y = self.points.mean(axis=0).tolist()
        return x, y

    @property
    def outline(self) -> Array:
        """Corners of a polygon for drawing, in [m]. Shape (n, 2)."""
        return self.points

    @cached_property
    def alone(self) -> "ObstacleSet":
        """The shape alone as a set."""
        return ObstacleSet((self,))

    def clearance(self, points: ArrayLike) -> Array:
        """Return signed distances of points (n, 2) from the edge, in [m]."""
        return self.alone.clearance(points)


@dataclass(frozen=True)
class ObstacleSet:
    """Obstacles in one frame, with vectorised distance queries."""

    shapes: tuple[Obstacle, ...] = ()

    def __len__(self) -> int:
        return len(self.shapes)

    def __iter__(self) -> Iterator[Obstacle]:
        return iter(self.shapes)

    @cached_property
    def packed(self) -> PackedObstacles:
        """The obstacles as arrays for compiled loops."""
        circles, edges, counts = np.zeros((len(self), 3)), [], [0]
        for circle, shape in zip(circles, self.shapes, strict=True):
            points = shape.points
            circle[:2] = points.mean(axis=0)
            reach = np.hypot(*(points - circle[:2]).T).max()
            circle[2] = reach + shape.rounding
            if len(points) > 1:
                ways = next_corners(points) - points
                lengths = np.hypot(ways[:, 0], ways[:, 1])
                planes = half_planes(points)
                edges.append(np.column_stack([*planes, points, lengths]))
            counts.append(len(points) if len(points) > 1 else 0)
        return PackedObstacles(
            circles,
            np.cumsum(counts),
            np.concatenate([np.zeros((0, 6)), *edges]),
        )

    def clearances(self, points: ArrayLike) -> Array:
        """Return signed distances [m] of points from each, (n, obstacles)."""
        queries = _rows(points)
        signed = np.empty((len(queries), len(self)))
        measure_points(self.packed, queries, signed)
        return signed

    def clearance(self, points: ArrayLike) -> Array:
        """Return signed distances [m] of points from the nearest, or inf."""
        queries = _rows(points)
        least = np.empty(len(queries))
        measure_nearest(self.packed, queries, least)
        return least

    def directions_out(self, points: ArrayLike) -> Array:
        """Return unit vectors away from each obstacle, (n, obstacles, 2).

        They are the gradients of the distances; zero at the centre of a disc.
        """
        queries = _rows(points)
        vectors = np.stack(
            [
                self.clearances(queries + step)
                - self.clearances(queries - step)
                for step in ((NUDGE, 0.0), (0.0, NUDGE))
            ],
            axis=-1,
        )
        lengths = np.hypot(vectors[..., 0], vectors[..., 1])[..., None]
        directions: Array = vectors / np.maximum(lengths, 0.1 * NUDGE)
        return directions

    def segments_keep_clear(
        self, allowed: ArrayLike, starts: ArrayLike, ends: ArrayLike
    ) -> Flags:
        """Return whether segments keep a distance [m] from every obstacle.

        The distance may be one for each obstacle; starts (n, 2) one for all.
        """
        last = _rows(ends)
        first = _rows(np.broadcast_to(starts, last.shape))
        enough = np.full(len(self), allowed, dtype=np.float64)
        found = np.empty((len(last), len(self)))
        measure_segments(self.packed, first, last, enough, found)
        return np.asarray((found >= enough).all(axis=1))

    def swept_clearances(self, corners: Array) -> Array:
        """Return lower bounds [m] of the clearance of a moving outline.

        Corners (instants, corners, 2) move along straight lines. The
        separation of two convex sets along any direction is a lower bound
        of their distance, and equals it along the best direction. Shape
        (instants - 1,), or (1,) for one instant.
        """
        if not len(self):
            return np.full(max(1, len(corners) - 1), inf)
        directions, nearest = self._separations
        reach = (corners @ directions).max(axis=1)
        if len(reach) > 1:
            reach = np.maximum(reach[:-1], reach[1:])
        separations = nearest[None, :, :] - reach[:, None, :]
        least: Array = separations.max(axis=2).min(axis=1)
        return least

    @cached_property
    def _separations(self) -> tuple[Array, Array]:
        """Directions (2, n), and the least coordinate [m] of each hull."""
        angles = np.arange(DIRECTION_COUNT) * (tau / DIRECTION_COUNT)
        even = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        # The distance from a long wall is exact only along its own normals.
        around = np.concatenate([even, -self.packed.edges[:, :2]])
        directions: Array = np.unique(np.round(around, 12), axis=0).T
        directions /= np.hypot(*directions)
        nearest = [
            (shape.points @ directions).min(axis=0) - shape.rounding
            for shape in self.shapes
        ]
        return directions, np.array(nearest)


def _rows(points: ArrayLike) -> Array:
    """Return points as rows of an array for compiled loops. Shape (n, 2)."""
    return np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 2)


def clearance_between(one: Obstacle, other: Obstacle) -> float:
    """Return the signed distance between two shapes in one frame, in [m].

    Where they overlap it is minus the penetration depth.
    """
    # Disjoint convex sets are separated along the normal of an edge, or
    # between two corners, which the distances of the points of each to the
    # other one cover; so do they for discs, which have no edges.
    overlap, distance = -inf, inf
    for a, b in ((one, other), (other, one)):
        edges = b.alone.packed.edges
        heights = a.points @ edges[:, :2].T - edges[:, 2]
        apart = heights.min(axis=0).max() if len(edges) else inf
        overlap = max(overlap, float(apart))
        distance = min(distance, b.clearance(a.points).min() - a.rounding)
    return overlap if overlap <= 0.0 else float(distance)


NO_OBSTACLES = ObstacleSet()
"""Obstacle set of an open floor."""
