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

from ..core.convex import half_planes
from ..core.poses import Array

DIRECTION_COUNT = 64  # uniform directions; the nearest is within 3 degrees
BLOCK_SIZE = 2**14  # points times edges in one block of arrays
Flags = NDArray[np.bool_]


class RoundedHull(NamedTuple):
    """Convex hull of points, grown by a radius (0 for several points).

    Attributes:
        points: Corners, counter-clockwise, in [m]. Shape (m, 2).
        normals: Outward unit normals of the edges. A single point has one
            edge of zero length whose half plane is empty. Shape (m, 2).
        offsets: Inside is ``normals @ p <= offsets``, in [m]. Shape (m,).
        radius: Radius by which the hull is grown, in [m].
    """

    points: Array
    normals: Array
    offsets: Array
    radius: float


def rounded_hull(points: ArrayLike, radius: float = 0.0) -> RoundedHull:
    """Return the hull of corners, grown by a radius; arrays are read-only.

    Args:
        points: Corners of a convex polygon, counter-clockwise, in [m], or
            one point. Shape (m, 2).
        radius: Radius, in [m]; 0 unless there is a single point.
    """
    corners = np.array(points, dtype=np.float64)
    normals, offsets = np.zeros((1, 2)), np.array([-inf])
    if len(corners) > 1:
        normals, offsets = half_planes(corners)
    for each in (corners, normals, offsets):
        each.setflags(write=False)
    return RoundedHull(corners, normals, offsets, radius)


class HullSet:
    """Rounded hulls in one frame.

    Attributes:
        hulls: The hulls.
    """

    def __init__(self, hulls: Iterable[RoundedHull]) -> None:
        """Concatenate the edges of the hulls.

        Args:
            hulls: Hulls in one frame.
        """
        self.hulls = tuple(hulls)
        counts = [len(h.points) for h in self.hulls]
        pairs = np.zeros((0, 2))
        points = [h.points for h in self.hulls]
        ends = [np.roll(each, -1, axis=0) for each in points]
        self._edge_starts: Array = np.concatenate([pairs, *points])
        self._edges: Array = np.concatenate([pairs, *ends]) - self._edge_starts
        self._normals: Array = np.concatenate(
            [pairs, *(h.normals for h in self.hulls)]
        )
        self._offsets: Array = np.concatenate(
            [np.zeros(0), *(h.offsets for h in self.hulls)]
        )
        self._radii = np.array([h.radius for h in self.hulls])
        self._hull_of_edge = np.repeat(np.arange(len(counts)), counts)
        self._first_edges = np.cumsum([0, *counts])[:-1].astype(np.int64)

    def clearances(self, points: ArrayLike) -> Array:
        """Return the signed distances from each hull, negative inside.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Distances, in [m]. Shape (n, hulls).
        """
        queries = np.asarray(points, dtype=np.float64)
        if not self.hulls:
            return np.zeros((len(queries), 0))
        heights = queries @ self._normals.T - self._offsets
        beyond = np.maximum.reduceat(heights, self._first_edges, axis=1)
        distances = np.hypot(*self._offsets_from_edges(queries))
        nearest = np.minimum.reduceat(distances, self._first_edges, axis=1)
        signed: Array = np.where(beyond <= 0.0, beyond, nearest) - self._radii
        return signed

    def clearance(self, points: ArrayLike) -> Array:
        """Return the distances from the nearest hull; inf without hulls.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Signed distances, in [m]. Shape (n,).
        """
        queries = np.asarray(points, dtype=np.float64)
        least: Array = np.full(len(queries), inf)
        rows = max(1, BLOCK_SIZE // max(1, len(self._edges)))
        for begin in range(0, len(queries) if self.hulls else 0, rows):
            block = slice(begin, begin + rows)
            least[block] = self.clearances(queries[block]).min(axis=1)
        return least

    def directions_out(self, points: ArrayLike) -> Array:
        """Return the gradients of the signed distances from each hull.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Unit vectors away from each hull; zero at the centre of a disc.
            Shape (n, hulls, 2).
        """
        queries = np.asarray(points, dtype=np.float64)
        heights = queries @ self._normals.T - self._offsets
        away = np.stack(self._offsets_from_edges(queries), axis=-1)
        distances = np.hypot(away[..., 0], away[..., 1])
        rows = np.arange(len(queries))
        vectors = np.zeros((len(queries), len(self.hulls), 2))
        for n, first in enumerate(self._first_edges.tolist()):
            own = slice(first, first + len(self.hulls[n].points))
            outside = away[rows, first + distances[:, own].argmin(axis=1)]
            inside = self._normals[first + heights[:, own].argmax(axis=1)]
            beyond = heights[:, own].max(axis=1, keepdims=True) > 0.0
            vectors[:, n] = np.where(beyond, outside, inside)
        lengths = np.hypot(vectors[..., 0], vectors[..., 1])[..., None]
        directions: Array = vectors / np.maximum(lengths, 1e-12)
        return directions

    def segments_intersect(self, starts: ArrayLike, ends: ArrayLike) -> Flags:
        """Return whether line segments touch each hull.

        Args:
            starts: Start points (x, y), in [m]. Shape (n, 2), or (1, 2) for
                a common start.
            ends: End points (x, y), in [m]. Shape (n, 2).

        Returns:
            True where segment and hull intersect. Shape (n, hulls).
        """
        start = np.asarray(starts, dtype=np.float64)
        end = np.asarray(ends, dtype=np.float64)
        if not self.hulls:
            return np.zeros((len(end), 0), dtype=np.bool_)
        distances = np.minimum.reduceat(
            _segment_distances(self._edge_starts, start, end),
            self._first_edges,
            axis=1,
        )
        near: Flags = distances <= self._radii
        return self._segments_cross_interior(start, end) | near

    def segments_keep_clear(
        self, allowed: Array, start: Array, ends: Array
    ) -> Flags:
        """Return whether line segments keep a distance from every hull.

        Args:
            allowed: Required distance from each hull, in [m]; start and ends
                must satisfy it. Shape (hulls,).
            start: Common start point, in [m]. Shape (2,).
            ends: End points, in [m]. Shape (n, 2).

        Returns:
            True where the whole segment keeps the distances. Shape (n,).
        """
        starts = start[None]
        least = (self._radii + allowed)[self._hull_of_edge]
        distances = _segment_distances(self._edge_starts, starts, ends)
        free: Flags = np.all(distances >= least, axis=1)
        if self.hulls:
            free[free] &= ~np.any(
                self._segments_cross_interior(starts, ends[free]), axis=1
            )
        return free

    def swept_clearances(self, corners: Array) -> Array:
        """Return lower bounds of the clearance of a moving outline.

        The separation of two convex sets along any direction is a lower
        bound of their distance, and equals it along the best direction. So
        the largest separation over a finite set of directions is
        conservative.

        Args:
            corners: Corners of the outline at successive instants, between
                which they move along straight lines, in [m]. Shape
                (instants, corners, 2).

        Returns:
            Lower bounds of the distance between the hull of two successive
            outlines and the nearest hull of this set, in [m]; not positive
            if they may touch, inf without hulls. Shape (instants - 1,), or
            (1,) for one instant.
        """
        if not self.hulls:
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
        sides = self._normals[np.isfinite(self._offsets)]
        around = np.concatenate([even, -sides])
        directions: Array = np.unique(np.round(around, 12), axis=0).T
        directions /= np.hypot(*directions)
        nearest = np.array(
            [
                (h.points @ directions).min(axis=0) - h.radius
                for h in self.hulls
            ]
        )
        return directions, nearest

    def _offsets_from_edges(self, points: Array) -> tuple[Array, Array]:
        """Return x and y from the nearest point of each edge. Shape (n, m)."""
        away = points[:, None] - self._edge_starts
        fraction = (away * self._edges).sum(axis=2)
        fraction /= np.maximum((self._edges**2).sum(axis=1), 1e-300)
        away -= np.clip(fraction, 0.0, 1.0)[..., None] * self._edges
        return away[..., 0], away[..., 1]

    def _segments_cross_interior(self, starts: Array, ends: Array) -> Flags:
        """Clip segments by the half planes of each hull (Cyrus-Beck).

        Returns whether any part of a segment remains. Shape (n, hulls).
        """
        firsts = self._first_edges
        height = starts @ self._normals.T - self._offsets  # (n, m), [m]
        slope = (ends - starts) @ self._normals.T
        parallel = np.abs(slope) < 1e-12  # to the edge
        with np.errstate(divide="ignore", invalid="ignore"):
            fraction = -height / slope
        enters = np.where(~parallel & (slope < 0.0), fraction, 0.0)
        leaves = np.where(~parallel & (slope > 0.0), fraction, 1.0)
        outside = np.logical_or.reduceat(parallel & (height > 0.0), firsts, 1)
        crossing: Flags = (
            np.maximum(np.maximum.reduceat(enters, firsts, axis=1), 0.0)
            <= np.minimum(np.minimum.reduceat(leaves, firsts, axis=1), 1.0)
        ) & ~outside
        return crossing


def _segment_distances(points: Array, starts: Array, ends: Array) -> Array:
    """Return distances of points from segments, in [m]. (segments, points)."""
    along = ends - starts
    away_x = points[:, 0] - starts[:, :1]
    away_y = points[:, 1] - starts[:, 1:]
    squares = np.maximum((along**2).sum(axis=1), 1e-300)[:, None]
    fraction = (along[:, :1] * away_x + along[:, 1:] * away_y) / squares
    fraction = np.clip(fraction, 0.0, 1.0)
    distances: Array = np.hypot(
        away_x - fraction * along[:, :1], away_y - fraction * along[:, 1:]
    )
    return distances
