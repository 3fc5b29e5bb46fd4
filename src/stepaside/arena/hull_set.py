"""Distances of points, segments and outlines from many convex shapes.

A shape is the convex hull of points, grown by a radius: a disc is one point
with a radius, a box four points with a radius of zero. All distances follow
from points, half planes and a radius.
"""

from collections.abc import Iterable
from functools import cached_property
from math import inf, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.poses import Array

DIRECTION_COUNT = 64  # uniform directions; the nearest is within 3 degrees
BLOCK_SIZE = 2**14  # points times edges in one block of arrays
Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]


class RoundedHull(NamedTuple):
    """Convex hull of points, grown by a radius (0 for several points).

    Attributes:
        points: Corners in the frame of the set, counter-clockwise, in [m].
            Shape (m, 2).
        radius: Radius by which the hull is grown, in [m].
    """

    points: Array
    radius: float


def rounded_hull(points: ArrayLike, radius: float = 0.0) -> RoundedHull:
    """Return the hull of corners, grown by a radius; the array is read-only.

    Args:
        points: Corners of a convex polygon in any frame, counter-clockwise,
            in [m], or
            one point. Shape (m, 2).
        radius: Radius, in [m]; 0 unless there is a single point.
    """
    corners = np.array(points, dtype=np.float64)
    corners.setflags(write=False)
    return RoundedHull(corners, radius)


class HullSet:
    """Rounded hulls in one frame, with the edges of all in one array.

    Attributes:
        radii: Radius of each hull, in [m]. Shape (hulls,).
        firsts: Index of the first edge of each hull. Shape (hulls,).
        hull_of_edge: Index of the hull of each edge. Shape (edges,).
        points: Start of each edge, in [m]. Shape (edges, 2).
        edges: Vector to its end, in [m]. A single point has one edge of zero
            length, whose half plane is empty. Shape (edges, 2).
        normals: Outward unit normals of the edges. Shape (edges, 2).
        offsets: Inside a hull is ``normals @ p <= offsets``, in [m]. Shape
            (edges,).
    """

    def __init__(self, hulls: Iterable[RoundedHull]) -> None:
        """Concatenate the edges of the hulls.

        Args:
            hulls: Hulls in one frame.
        """
        parts = [(hull.points, hull.radius) for hull in hulls]
        counts = np.array([len(points) for points, _ in parts], dtype=np.int64)
        ends = np.cumsum(counts)
        self.radii: Array = np.array([radius for _, radius in parts])
        self.firsts = ends - counts
        self.hull_of_edge = np.repeat(np.arange(len(counts)), counts)
        self.points: Array = np.concatenate(
            [np.zeros((0, 2)), *(points for points, _ in parts)]
        )
        after = np.arange(1, len(self.points) + 1)
        after[ends - 1] = self.firsts
        self.edges: Array = self.points[after] - self.points
        lengths = np.hypot(self.edges[:, 0], self.edges[:, 1])
        with np.errstate(invalid="ignore"):
            normals = self.edges[:, ::-1] * (1.0, -1.0) / lengths[:, None]
        single = lengths == 0.0
        self.normals: Array = np.where(single[:, None], 0.0, normals)
        self.offsets: Array = np.where(
            single, -inf, (self.normals * self.points).sum(axis=1)
        )

    def __len__(self) -> int:
        """Return the number of hulls."""
        return len(self.firsts)

    @cached_property
    def circles(self) -> Array:
        """Centre x, y and radius of a circle around each hull, in [m].

        Shape (hulls, 3).
        """
        if not len(self):
            return np.zeros((0, 3))
        counts = np.diff([*self.firsts, len(self.points)])
        centres = np.add.reduceat(self.points, self.firsts) / counts[:, None]
        reach = np.hypot(*(self.points - centres[self.hull_of_edge]).T)
        farthest = np.maximum.reduceat(reach, self.firsts) + self.radii
        return np.column_stack([centres, farthest])

    def clearances(self, points: ArrayLike) -> Array:
        """Return the signed distances from each hull, negative inside.

        Args:
            points: Points (x, y) in the frame of the set, in [m]. Shape
                (n, 2).

        Returns:
            Distances, in [m]. Shape (n, hulls).
        """
        queries = np.asarray(points, dtype=np.float64)
        if not len(self):
            return np.zeros((len(queries), 0))
        heights = queries @ self.normals.T - self.offsets
        beyond = np.maximum.reduceat(heights, self.firsts, axis=1)
        distances = np.hypot(*self._offsets_from_edges(queries))
        nearest = np.minimum.reduceat(distances, self.firsts, axis=1)
        signed: Array = np.where(beyond <= 0.0, beyond, nearest) - self.radii
        return signed

    def clearance(self, points: ArrayLike) -> Array:
        """Return the distances from the nearest hull; inf without hulls.

        Args:
            points: Points (x, y) in the frame of the set, in [m]. Shape
                (n, 2).

        Returns:
            Signed distances, in [m]. Shape (n,).
        """
        queries = np.asarray(points, dtype=np.float64)
        least: Array = np.full(len(queries), inf)
        rows = max(1, BLOCK_SIZE // max(1, len(self.edges)))
        for begin in range(0, len(queries) if len(self) else 0, rows):
            block = slice(begin, begin + rows)
            least[block] = self.clearances(queries[block]).min(axis=1)
        return least

    def directions_out(self, points: ArrayLike) -> Array:
        """Return the gradients of the signed distances from each hull.

        Args:
            points: Points (x, y) in the frame of the set, in [m]. Shape
                (n, 2).

        Returns:
            Unit vectors away from each hull; zero at the centre of a disc.
            Shape (n, hulls, 2).
        """
        queries = np.asarray(points, dtype=np.float64)
        heights = queries @ self.normals.T - self.offsets
        away = np.stack(self._offsets_from_edges(queries), axis=-1)
        distances = np.hypot(away[..., 0], away[..., 1])
        rows = np.arange(len(queries))
        vectors = np.zeros((len(queries), len(self), 2))
        ends = [*self.firsts[1:].tolist(), len(self.points)]
        for n, first in enumerate(self.firsts.tolist()):
            own = slice(first, ends[n])
            outside = away[rows, first + distances[:, own].argmin(axis=1)]
            inside = self.normals[first + heights[:, own].argmax(axis=1)]
            beyond = heights[:, own].max(axis=1, keepdims=True) > 0.0
            vectors[:, n] = np.where(beyond, outside, inside)
        lengths = np.hypot(vectors[..., 0], vectors[..., 1])[..., None]
        directions: Array = vectors / np.maximum(lengths, 1e-12)
        return directions

    def segments_intersect(self, starts: ArrayLike, ends: ArrayLike) -> Flags:
        """Return whether line segments touch each hull.

        Args:
            starts: Start points (x, y) in the frame of the set, in [m].
                Shape (n, 2), or (1, 2) for
                a common start.
            ends: End points (x, y), in [m]. Shape (n, 2).

        Returns:
            True where segment and hull intersect. Shape (n, hulls).
        """
        start = np.asarray(starts, dtype=np.float64)
        end = np.asarray(ends, dtype=np.float64)
        from_centres = self._distances_from_centres(start, end)
        distances = self._segment_distances(
            start, end, self.radii, from_centres
        )
        hit: Flags = distances <= self.radii
        return hit

    def segments_keep_clear(
        self, allowed: Array, starts: Array, ends: Array
    ) -> Flags:
        """Return whether line segments keep a distance from every hull.

        Args:
            allowed: Required distance from each hull, in [m]; starts and ends
                must satisfy it. Shape (hulls,).
            starts: Start points in the frame of the set, in [m]. Shape (n,
                2), or (1, 2) for a
                common start.
            ends: End points, in [m]. Shape (n, 2).

        Returns:
            True where the whole segment keeps the distances. Shape (n,).
        """
        least = self.radii + allowed
        from_centres = self._distances_from_centres(starts, ends)
        free: Flags = np.all(from_centres >= least, axis=1)
        # The centre lies inside its hull: few segments are left to measure.
        distances = self._segment_distances(
            starts if len(starts) == 1 else starts[free],
            ends[free],
            least,
            from_centres[free],
        )
        free[free] = np.all(distances >= least, axis=1)
        return free

    def swept_clearances(self, corners: Array) -> Array:
        """Return lower bounds of the clearance of a moving outline.

        The separation of two convex sets along any direction is a lower
        bound of their distance, and equals it along the best direction. So
        the largest separation over a finite set of directions is
        conservative.

        Args:
            corners: Corners of the outline in the frame of the set at
                successive instants, between
                which they move along straight lines, in [m]. Shape
                (instants, corners, 2).

        Returns:
            Lower bounds of the distance between the hull of two successive
            outlines and the nearest hull of this set, in [m]; not positive
            if they may touch, inf without hulls. Shape (instants - 1,), or
            (1,) for one instant.
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
        """Return directions, and the least coordinate of each hull along them.

        Shapes (2, directions) and (hulls, directions), the latter in [m].
        """
        angles = np.arange(DIRECTION_COUNT) * (tau / DIRECTION_COUNT)
        even = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        # The distance from a long wall is exact only along its own normals.
        sides = self.normals[np.isfinite(self.offsets)]
        around = np.concatenate([even, -sides])
        directions: Array = np.unique(np.round(around, 12), axis=0).T
        directions /= np.hypot(*directions)
        along = self.points @ directions
        nearest = np.minimum.reduceat(along, self.firsts)
        nearest -= self.radii[:, None]
        return directions, nearest

    def _offsets_from_edges(self, points: Array) -> tuple[Array, Array]:
        """Return x and y from the nearest point of each edge. Shape (n, m)."""
        away = points[:, None] - self.points
        fraction = (away * self.edges).sum(axis=2)
        fraction /= np.maximum((self.edges**2).sum(axis=1), 1e-300)
        away -= np.clip(fraction, 0.0, 1.0)[..., None] * self.edges
        return away[..., 0], away[..., 1]

    def _distances_from_centres(self, starts: Array, ends: Array) -> Array:
        """Return distances of segments from the centre of each hull, in [m].

        Shape (n, hulls).
        """
        return _distances(self.circles[None, :, :2], starts, ends)

    def _segment_distances(
        self, starts: Array, ends: Array, most: Array, from_centres: Array
    ) -> Array:
        """Return distances of segments from the corners of each hull.

        Args:
            starts: Start points, in [m]. Shape (n, 2) or (1, 2).
            ends: End points, in [m]. Shape (n, 2).
            most: Distance of interest from each hull, in [m]. Shape (hulls,).
            from_centres: Distances from the centres of the hulls, in [m].
                Shape (n, hulls).

        Returns:
            Distances without the radius of the hull, in [m]; -inf if the
            segment crosses the interior, inf at hulls farther than ``most``.
            Shape (n, hulls).
        """
        found = np.full((len(ends), len(self)), inf)
        reach = self.circles[:, 2] - self.radii + most
        segment, hull = np.nonzero(from_centres <= reach)
        if not len(segment):
            return found
        counts = np.diff([*self.firsts, len(self.points)])[hull]
        last = np.cumsum(counts)
        firsts = last - counts
        rows = np.repeat(segment, counts)
        edge = np.arange(len(rows))
        edge += np.repeat(self.firsts[hull] - firsts, counts)
        start = starts[rows] if len(starts) > 1 else starts
        distances = np.minimum.reduceat(
            _distances(self.points[edge], start, ends[rows]), firsts
        )
        crossing = self._crosses_interior(edge, start, ends[rows], firsts)
        found[segment, hull] = np.where(crossing, -inf, distances)
        return found

    def _crosses_interior(
        self, edge: Indices, starts: Array, ends: Array, firsts: Indices
    ) -> Flags:
        """Clip segments by the half planes of a hull each (Cyrus-Beck).

        Args:
            edge: Edges, those of each hull in a row. Shape (m,).
            starts: Start of the segment that each edge clips, in [m]. Shape
                (m, 2).
            ends: Its end, in [m]. Shape (m, 2).
            firsts: Index of the first edge of each pair of segment and hull.
                Shape (n,).

        Returns:
            Whether any part of each segment remains. Shape (n,).
        """
        normals = self.normals[edge]
        height = (starts * normals).sum(axis=1) - self.offsets[edge]  # [m]
        slope = ((ends - starts) * normals).sum(axis=1)
        parallel = np.abs(slope) < 1e-12  # to the edge
        with np.errstate(divide="ignore", invalid="ignore"):
            fraction = -height / slope
        enters = np.where(~parallel & (slope < 0.0), fraction, 0.0)
        leaves = np.where(~parallel & (slope > 0.0), fraction, 1.0)
        outside = np.logical_or.reduceat(parallel & (height > 0.0), firsts)
        crossing: Flags = (
            np.maximum(np.maximum.reduceat(enters, firsts), 0.0)
            <= np.minimum(np.minimum.reduceat(leaves, firsts), 1.0)
        ) & ~outside
        return crossing


def _distances(points: Array, starts: Array, ends: Array) -> Array:
    """Return distances of points from segments, in [m].

    Args:
        points: Points, in [m]. Shape (n, 2), or (1, m, 2) for each of n
            segments.
        starts: Start of each segment, in [m]. Shape (n, 2) or (1, 2).
        ends: End of each segment, in [m]. Shape (n, 2).

    Returns:
        Shape (n,), or (n, m).
    """
    along = ends - starts
    squares = np.maximum((along**2).sum(axis=1), 1e-300)
    x, y = along.T
    u, v = starts.T
    if points.ndim == 3:
        x, y, u, v, squares = (a[:, None] for a in (x, y, u, v, squares))
    away_x, away_y = points[..., 0] - u, points[..., 1] - v
    fraction = np.clip((x * away_x + y * away_y) / squares, 0.0, 1.0)
    distances: Array = np.hypot(away_x - fraction * x, away_y - fraction * y)
    return distances
