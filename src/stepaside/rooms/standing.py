"""All that stands on a floor at once, for many points and lines."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..poses import Array
from .room import Obstacle
from .shapes import Disc


class Standing:
    """Discs and the edges of all polygons, as arrays."""

    def __init__(self, solids: tuple[Obstacle, ...]) -> None:
        """Lay them out.

        Args:
            solids: What stands there.
        """
        discs = [(n, s) for n, s in enumerate(solids) if isinstance(s, Disc)]
        self._discs = np.array([n for n, _ in discs], dtype=np.int64)
        self._centres = np.array([s.centre for _, s in discs]).reshape(-1, 2)
        self._radii = np.array([s.radius for _, s in discs])
        polygons = [
            (n, s) for n, s in enumerate(solids) if not isinstance(s, Disc)
        ]
        none = np.zeros((0, 2))
        points = [s.points for _, s in polygons]
        self._begins: Array = np.concatenate([none, *points])
        self._ends: Array = np.concatenate(
            [none, *(np.roll(each, -1, axis=0) for each in points)]
        )
        self._normals: Array = np.concatenate(
            [none, *(s.normals for _, s in polygons)]
        )
        self._offsets = (self._normals * self._begins).sum(axis=1)
        counts = [len(each) for each in points]
        self._polygons = np.array([n for n, _ in polygons], dtype=np.int64)
        self._owners = np.repeat(self._polygons, counts)
        self._firsts = np.cumsum([0, *counts])[:-1].astype(np.int64)
        self._count = len(solids)

    def clearances(self, points: Array) -> Array:
        """Signed distances of points from each solid, negative inside.

        Args:
            points: Points, in [m]. Shape (n, 2).

        Returns:
            Distances, in [m]. Shape (n, solids).
        """
        found = np.zeros((len(points), self._count))
        away = points[:, None] - self._centres
        found[:, self._discs] = np.hypot(away[..., 0], away[..., 1])
        found[:, self._discs] -= self._radii
        if not len(self._polygons):
            return found
        heights = points @ self._normals.T - self._offsets
        beyond = np.maximum.reduceat(heights, self._firsts, axis=1)
        edges = self._ends - self._begins
        away = points[:, None] - self._begins
        share = (away * edges).sum(axis=2) / (edges**2).sum(axis=1)
        away -= np.clip(share, 0.0, 1.0)[..., None] * edges
        apart = np.hypot(away[..., 0], away[..., 1])
        nearest = np.minimum.reduceat(apart, self._firsts, axis=1)
        found[:, self._polygons] = np.where(beyond <= 0.0, beyond, nearest)
        return found

    def free(
        self, allowed: Array, start: Array, ends: Array
    ) -> NDArray[np.bool_]:
        """Whether lines keep as far from everything as they must.

        Args:
            allowed: Distance from each solid, in [m], which start and ends
                keep. Shape (solids,).
            start: Where all lines begin, in [m]. Shape (2,).
            ends: Where they end. Shape (n, 2).
        """
        around = np.maximum(1e-3, self._radii + allowed[self._discs])
        clear = allowed[self._owners]
        free: NDArray[np.bool_] = np.all(
            _apart(self._centres, start, ends) > around, axis=1
        )
        free &= (_apart(self._begins, start, ends) >= clear).all(axis=1)
        free[free] &= ~self._met(start, ends[free])
        return free

    def _met(self, start: Array, ends: Array) -> NDArray[np.bool_]:
        """Whether lines from a place meet an edge. Shape (n,)."""
        edges, along = self._ends - self._begins, ends - start
        to = self._begins - start
        cross = along[:, :1] * edges[:, 1] - along[:, 1:] * edges[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = (to[:, 0] * edges[:, 1] - to[:, 1] * edges[:, 0]) / cross
            aside = (to[:, 0] * along[:, 1:] - to[:, 1] * along[:, :1]) / cross
        inside = (ahead >= 0.0) & (ahead <= 1.0)
        met: NDArray[np.bool_] = np.any(
            inside & (aside >= 0.0) & (aside <= 1.0), axis=1
        )
        return met


standing = lru_cache(maxsize=16)(Standing)
"""What stands on a floor, laid out once."""


def _apart(points: Array, start: Array, ends: Array) -> Array:
    """Distances of points from lines, in [m]. Shape (lines, points)."""
    along, away = ends - start, points - start
    squares = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(along @ away.T / squares[:, None], 0.0, 1.0)
    found: Array = np.hypot(
        away[:, 0] - share * along[:, :1], away[:, 1] - share * along[:, 1:]
    )
    return found
