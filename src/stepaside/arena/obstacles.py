"""Obstacles on the floor: the base class of shapes, and sets of them."""

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
        kind: "disc", "box" or "polygon".
    """

    kind: ClassVar[str]

    @property
    @abstractmethod
    def hull(self) -> RoundedHull:
        """The shape as points, half planes and a radius."""

    @abstractmethod
    def moved(self, pose: Pose) -> "Obstacle":
        """Transform the shape.

        Args:
            pose: Pose of the shape's frame in the target frame.
        """

    @property
    def centre(self) -> tuple[float, float]:
        """Mean of the points, which lies inside, (x, y), in [m]."""
        x, y = self.points.mean(axis=0).tolist()
        return x, y

    @property
    def outline(self) -> Array:
        """Corners of a polygon for drawing, in [m]. Shape (n, 2)."""
        return self.points

    @property
    def points(self) -> Array:
        """Corners, counter-clockwise, or the centre of a disc, in [m]."""
        return self.hull.points

    @property
    def area(self) -> float:
        """Area of the footprint, in [m^2]."""
        return signed_area(self.points) + pi * self.hull.radius**2

    @cached_property
    def _hull_set(self) -> HullSet:
        return HullSet((self.hull,))

    def clearance(self, points: ArrayLike) -> Array:
        """Return the signed distances of points from the edge.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Distances, negative inside, in [m]. Shape (n,).
        """
        return self._hull_set.clearances(points)[:, 0]


def clearance_between(one: Obstacle, other: Obstacle) -> float:
    """Return the signed distance between two shapes in one frame, in [m].

    Where they overlap it is minus the penetration depth.
    """
    # Disjoint convex sets are separated along the normal of an edge, or
    # between two corners, which the distances of the points of each to the
    # other one cover; so do they for discs, which have no edges.
    a, b = one.hull, other.hull
    overlap = max(
        float((p.points @ q.normals.T - q.offsets).min(axis=0).max())
        for p, q in ((a, b), (b, a))
    )
    if overlap <= 0.0:
        return overlap
    distance = one.clearance(b.points).min() - b.radius
    return float(min(distance, other.clearance(a.points).min() - a.radius))


class PackedObstacles(NamedTuple):
    """Discs and convex polygons as arrays, for compiled loops.

    Attributes:
        discs: Centre x, y and radius, in [m]. Shape (n, 3).
        edges: Edges of all polygons, concatenated: outward unit normal,
            offset [m], first corner x, y [m], length [m]. Shape (m, 6).
        firsts: Index of the first edge of each polygon, and the number of
            edges. Shape (polygons + 1,).
        rounds: Centre x, y and radius of a bounding circle of each polygon,
            in [m]. Shape (polygons, 3).
    """

    discs: Any
    edges: Any
    firsts: Any
    rounds: Any


class ObstacleSet(HullSet):
    """Obstacles in one frame, with vectorised distance queries.

    Attributes:
        shapes: The obstacles.
    """

    def __init__(self, shapes: Iterable[Obstacle]) -> None:
        """Concatenate the edges of the obstacles.

        Args:
            shapes: Obstacles in one frame.
        """
        self.shapes = tuple(shapes)
        super().__init__(shape.hull for shape in self.shapes)

    @cached_property
    def packed(self) -> PackedObstacles:
        """The obstacles as arrays for compiled loops."""
        polygons = [s for s in self.shapes if len(s.points) > 1]
        rounds = [
            (*s.centre, np.hypot(*(s.points - s.centre).T).max())
            for s in polygons
        ]
        lengths = np.hypot(self._edges[:, 0], self._edges[:, 1])
        edges = np.column_stack(
            [self._normals, self._offsets, self._edge_starts, lengths]
        )
        sides = np.isfinite(self._offsets)
        return PackedObstacles(
            np.column_stack(
                [self._edge_starts, self._radii[self._hull_of_edge]]
            )[~sides],
            edges[sides],
            np.cumsum([0, *(len(s.points) for s in polygons)]),
            np.array(rounds, dtype=np.float64).reshape(-1, 3),
        )


obstacle_set = lru_cache(maxsize=64)(ObstacleSet)
"""Return the set of a tuple of obstacles, cached."""

NO_OBSTACLES = ObstacleSet(())
"""Obstacle set of an open floor."""
