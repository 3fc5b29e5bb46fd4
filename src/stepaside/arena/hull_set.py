"""Distances of points, lines and outlines from many convex shapes at once.

A shape is the convex hull of points, grown by a radius: a disc is one point,
a box has four and is grown by nothing. So all that is asked of a shape is
asked of points, half planes and a radius.
"""

from collections.abc import Iterable
from functools import cached_property
from math import inf, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.convex import half_planes
from ..core.poses import Array

EVEN = 64  # directions all around, so that one is within 3 degrees
BLOCK = 2**14  # points times edges that are measured at once
Touches = NDArray[np.bool_]


class RoundedHull(NamedTuple):
    """Convex hull of points, grown by a radius; more than one by 0.

    Attributes:
        points: Corners, counter-clockwise, in [m]. Shape (m, 2).
        normals: Outward unit normals of the edges; a single point has an
            edge without length, outside of which is everything. Shape (m, 2).
        offsets: Inside is ``normals @ p <= offsets``, in [m]. Shape (m,).
        radius: In [m].
    """

    points: Array
    normals: Array
    offsets: Array
    radius: float


def rounded_hull(points: ArrayLike, radius: float = 0.0) -> RoundedHull:
    """Return the hull of corners, grown by a radius; arrays are read-only.

    Args:
        points: Corners of a convex polygon, counter-clockwise, in [m]; or
            one point. Shape (m, 2).
        radius: In [m]; 0 unless there is one point.
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
        """Lay them out.

        Args:
            hulls: In one frame.
        """
        self.hulls = tuple(hulls)
        counts = [len(h.points) for h in self.hulls]
        pairs = np.zeros((0, 2))
        points = [h.points for h in self.hulls]
        ends = [np.roll(each, -1, axis=0) for each in points]
        self._begins: Array = np.concatenate([pairs, *points])
        self._edges: Array = np.concatenate([pairs, *ends]) - self._begins
        self._normals: Array = np.concatenate(
            [pairs, *(h.normals for h in self.hulls)]
        )
        self._offsets: Array = np.concatenate(
            [np.zeros(0), *(h.offsets for h in self.hulls)]
        )
        self._radii = np.array([h.radius for h in self.hulls])
        self._owners = np.repeat(np.arange(len(counts)), counts)
        self._firsts = np.cumsum([0, *counts])[:-1].astype(np.int64)

    def clearances(self, points: ArrayLike) -> Array:
        """Return signed distances from each hull, negative inside.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Distances, in [m]. Shape (n, hulls).
        """
        asked = np.asarray(points, dtype=np.float64)
        if not self.hulls:
            return np.zeros((len(asked), 0))
        heights = asked @ self._normals.T - self._offsets
        beyond = np.maximum.reduceat(heights, self._firsts, axis=1)
        apart = np.hypot(*self._from_edges(asked))
        nearest = np.minimum.reduceat(apart, self._firsts, axis=1)
        found: Array = np.where(beyond <= 0.0, beyond, nearest) - self._radii
        return found

    def clearance(self, points: ArrayLike) -> Array:
        """Return distances from the nearest hull; infinite without any.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Signed distances, in [m]. Shape (n,).
        """
        asked = np.asarray(points, dtype=np.float64)
        found: Array = np.full(len(asked), inf)
        rows = max(1, BLOCK // max(1, len(self._edges)))
        for begin in range(0, len(asked) if self.hulls else 0, rows):
            block = slice(begin, begin + rows)
            found[block] = self.clearances(asked[block]).min(axis=1)
        return found

    def directions_out(self, points: ArrayLike) -> Array:
        """Return the unit vectors that lead straight away from each.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Vectors; zero at the centre of a disc. Shape (n, hulls, 2).
        """
        asked = np.asarray(points, dtype=np.float64)
        heights = asked @ self._normals.T - self._offsets
        away = np.stack(self._from_edges(asked), axis=-1)
        apart = np.hypot(away[..., 0], away[..., 1])
        rows = np.arange(len(asked))
        ways = np.zeros((len(asked), len(self.hulls), 2))
        for n, first in enumerate(self._firsts.tolist()):
            own = slice(first, first + len(self.hulls[n].points))
            outside = away[rows, first + apart[:, own].argmin(axis=1)]
            inside = self._normals[first + heights[:, own].argmax(axis=1)]
            beyond = heights[:, own].max(axis=1, keepdims=True) > 0.0
            ways[:, n] = np.where(beyond, outside, inside)
        lengths = np.hypot(ways[..., 0], ways[..., 1])[..., None]
        found: Array = ways / np.maximum(lengths, 1e-12)
        return found

    def crossed(self, starts: ArrayLike, ends: ArrayLike) -> Touches:
        """Return whether straight lines touch each hull.

        Args:
            starts: Where the lines begin, (x, y), in [m]. Shape (n, 2), or
                (1, 2) for all of them.
            ends: Where they end. Shape (n, 2).

        Returns:
            Shape (n, hulls).
        """
        start = np.asarray(starts, dtype=np.float64)
        end = np.asarray(ends, dtype=np.float64)
        if not self.hulls:
            return np.zeros((len(end), 0), dtype=np.bool_)
        apart = np.minimum.reduceat(
            _apart(self._begins, start, end), self._firsts, axis=1
        )
        found: Touches = self._clipped(start, end) | (apart <= self._radii)
        return found

    def keep_clear(self, allowed: Array, start: Array, ends: Array) -> Touches:
        """Return whether lines keep as far from everything as they must.

        Args:
            allowed: Distance from each hull, in [m], which start and ends
                keep. Shape (hulls,).
            start: Where all lines begin, in [m]. Shape (2,).
            ends: Where they end. Shape (n, 2).

        Returns:
            Shape (n,).
        """
        starts, least = start[None], (self._radii + allowed)[self._owners]
        apart = _apart(self._begins, starts, ends)
        free: Touches = np.all(apart >= least, axis=1)
        if self.hulls:
            free[free] &= ~np.any(self._clipped(starts, ends[free]), axis=1)
        return free

    def swept_clearances(self, corners: Array) -> Array:
        """Return the distance that a moving outline keeps from everything.

        Two convex sets lie apart by at least what separates them along any
        direction, and by exactly that along the right one. So the largest
        separation along some directions is never more than the distance:
        what it calls clear is clear.

        Args:
            corners: Of the outline at instants; from one to the next its
                corners move straight. Shape (instants, corners, 2), in [m].

        Returns:
            Lower bounds of the distance between the hull of each two
            outlines that follow each other and the nearest hull, in
            [m]; not positive if they may touch, infinite without hulls.
            Shape (instants - 1,), or (1,) of one instant.
        """
        if not self.hulls:
            return np.full(max(1, len(corners) - 1), inf)
        directions, nearest = self._separations
        reach = (corners @ directions).max(axis=1)
        if len(reach) > 1:
            reach = np.maximum(reach[:-1], reach[1:])
        apart = nearest[None, :, :] - reach[:, None, :]
        found: Array = apart.max(axis=2).min(axis=1)
        return found

    @cached_property
    def _separations(self) -> tuple[Array, Array]:
        """Directions, and how far each hull begins along them, in [m].

        Shapes (2, directions), (hulls, directions).
        """
        angles = np.arange(EVEN) * (tau / EVEN)
        even = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        # A long wall is only told exactly along its own normals.
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

    def _from_edges(self, points: Array) -> tuple[Array, Array]:
        """Return x and y from the nearest points of all edges. (n, m)."""
        away = points[:, None] - self._begins
        share = (away * self._edges).sum(axis=2)
        share /= np.maximum((self._edges**2).sum(axis=1), 1e-300)
        away -= np.clip(share, 0.0, 1.0)[..., None] * self._edges
        return away[..., 0], away[..., 1]

    def _clipped(self, starts: Array, ends: Array) -> Touches:
        """Return whether anything of a line is left inside all edges.

        Shape (n, hulls).
        """
        firsts = self._firsts
        height = starts @ self._normals.T - self._offsets  # (n, m), [m]
        slope = (ends - starts) @ self._normals.T
        still = np.abs(slope) < 1e-12  # runs along the edge
        with np.errstate(divide="ignore", invalid="ignore"):
            share = -height / slope
        enters = np.where(~still & (slope < 0.0), share, 0.0)
        leaves = np.where(~still & (slope > 0.0), share, 1.0)
        outside = np.logical_or.reduceat(still & (height > 0.0), firsts, 1)
        found: Touches = (
            np.maximum(np.maximum.reduceat(enters, firsts, axis=1), 0.0)
            <= np.minimum(np.minimum.reduceat(leaves, firsts, axis=1), 1.0)
        ) & ~outside
        return found


def _apart(points: Array, starts: Array, ends: Array) -> Array:
    """Return distances of points from lines, in [m]. Shape (lines, points)."""
    along = ends - starts
    away_x = points[:, 0] - starts[:, :1]
    away_y = points[:, 1] - starts[:, 1:]
    squares = np.maximum((along**2).sum(axis=1), 1e-300)[:, None]
    share = (along[:, :1] * away_x + along[:, 1:] * away_y) / squares
    share = np.clip(share, 0.0, 1.0)
    found: Array = np.hypot(
        away_x - share * along[:, :1], away_y - share * along[:, 1:]
    )
    return found
