"""Obstacles on the floor: what every shape has, and sets of them."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import pi
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.convex import signed_area
from ..core.poses import Array, Pose
from .hull_set import HullSet, RoundedHull


@dataclass(frozen=True)
class Obstacle(ABC):
    """Convex shape on the floor.

    Attributes:
        kind: Name of its sort: "disc", "box" or "polygon".
    """

    kind: ClassVar[str]

    @property
    @abstractmethod
    def hull(self) -> RoundedHull:
        """Points, half planes and radius."""

    @abstractmethod
    def moved(self, pose: Pose) -> "Obstacle":
        """Return the shape in the frame in which its own has a pose."""

    @property
    def centre(self) -> tuple[float, float]:
        """Mean of the points, which lies inside, (x, y), in [m]."""
        x, y = self.points.mean(axis=0).tolist()
        return x, y

    @property
    def outline(self) -> Array:
        """Corners of a polygon to draw, in [m]. Shape (n, 2)."""
        return self.points

    @property
    def points(self) -> Array:
        """Corners, counter-clockwise, in [m], read-only; a disc's centre."""
        return self.hull.points

    @property
    def area(self) -> float:
        """Floor that it covers, in [m^2]."""
        return signed_area(self.points) + pi * self.hull.radius**2

    @cached_property
    def _alone(self) -> HullSet:
        return HullSet((self.hull,))

    def clearance(self, points: ArrayLike) -> Array:
        """Return the distances of points from the edge, negative inside.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Signed distances, in [m]. Shape (n,).
        """
        return self._alone.clearances(points)[:, 0]


def clearance_between(one: Obstacle, other: Obstacle) -> float:
    """Return the distance between two shapes in one frame, in [m].

    Where they overlap it is minus the least way by which one of them would
    have to move for them not to.
    """
    # Convex sets that lie apart do so along the normal of an edge; that
    # of two corners is found from the points of each to the other, and so
    # is that of a disc, which has no edges.
    a, b = one.hull, other.hull
    overlap = max(
        float((p.points @ q.normals.T - q.offsets).min(axis=0).max())
        for p, q in ((a, b), (b, a))
    )
    if overlap <= 0.0:
        return overlap
    apart = one.clearance(b.points).min() - b.radius
    return float(min(apart, other.clearance(a.points).min() - a.radius))


class PackedObstacles(NamedTuple):
    """Discs and convex polygons in arrays, for compiled loops.

    Attributes:
        discs: Centre x, y and radius, in [m]. Shape (n, 3).
        edges: Of all polygons, one after the other: outward unit normal,
            offset [m], corner x, y where it begins [m], its length [m].
            Shape (m, 6).
        firsts: Where each polygon begins in them, and where the last ends.
            Shape (polygons + 1,).
        rounds: Centre x, y and radius of a circle around each polygon, in
            [m]. Shape (polygons, 3).
    """

    discs: Any
    edges: Any
    firsts: Any
    rounds: Any


class ObstacleSet(HullSet):
    """Obstacles in one frame, for many points, lines and outlines at once.

    Attributes:
        shapes: The obstacles.
    """

    def __init__(self, shapes: Iterable[Obstacle]) -> None:
        """Lay them out.

        Args:
            shapes: In one frame.
        """
        self.shapes = tuple(shapes)
        super().__init__(shape.hull for shape in self.shapes)

    @cached_property
    def packed(self) -> PackedObstacles:
        """The same obstacles for compiled loops."""
        polygons = [s for s in self.shapes if len(s.points) > 1]
        rounds = [
            (*s.centre, np.hypot(*(s.points - s.centre).T).max())
            for s in polygons
        ]
        lengths = np.hypot(self._edges[:, 0], self._edges[:, 1])
        edges = np.column_stack(
            [self._normals, self._offsets, self._begins, lengths]
        )
        sides = np.isfinite(self._offsets)
        return PackedObstacles(
            np.column_stack([self._begins, self._radii[self._owners]])[~sides],
            edges[sides],
            np.cumsum([0, *(len(s.points) for s in polygons)]),
            np.array(rounds, dtype=np.float64).reshape(-1, 3),
        )


obstacle_set = lru_cache(maxsize=64)(ObstacleSet)
"""The set of a tuple of obstacles, laid out once."""

NO_OBSTACLES = ObstacleSet(())
"""An open floor."""
