"""Obstacles on the floor: the base class of shapes, and sets of them."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
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
        """The shape as points and a radius."""

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
    def hull_set(self) -> HullSet:
        """The shape alone as a set of hulls."""
        return HullSet((self.hull,))

    def clearance(self, points: ArrayLike) -> Array:
        """Return the signed distances of points from the edge.

        Args:
            points: Points (x, y) in the frame of the shape, in [m]. Shape
                (n, 2).

        Returns:
            Distances, negative inside, in [m]. Shape (n,).
        """
        return self.hull_set.clearances(points)[:, 0]


def clearance_between(one: Obstacle, other: Obstacle) -> float:
    """Return the signed distance between two shapes in one frame, in [m].

    Where they overlap it is minus the penetration depth.
    """
    # Disjoint convex sets are separated along the normal of an edge, or
    # between two corners, which the distances of the points of each to the
    # other one cover; so do they for discs, which have no edges.
    a, b = one.hull_set, other.hull_set
    overlap = max(
        float((p.points @ q.normals.T - q.offsets).min(axis=0).max())
        for p, q in ((a, b), (b, a))
    )
    if overlap <= 0.0:
        return overlap
    distance = a.clearance(b.points).min() - b.radii[0]
    return float(min(distance, b.clearance(a.points).min() - a.radii[0]))


class PackedObstacles(NamedTuple):
    """Discs and convex polygons as arrays, for compiled loops.

    Attributes:
        circles: Centre x, y and radius of a circle around each obstacle, in
            [m]. Shape (obstacles, 3).
        firsts: Index of the first edge of each obstacle, and the number of
            edges. A disc has none: it is its circle. Shape (obstacles + 1,).
        edges: Edges of all polygons, concatenated: outward unit normal,
            offset [m], first corner x, y [m], length [m]. Shape (m, 6).
    """

    circles: Any
    firsts: Any
    edges: Any


class ObstacleSet(HullSet):
    """Obstacles in one frame, with vectorised distance queries.

    Iteration yields the obstacles.

    Attributes:
        shapes: The obstacles.
    """

    def __init__(self, shapes: Iterable[Obstacle] = ()) -> None:
        """Concatenate the edges of the obstacles.

        Args:
            shapes: Obstacles in one frame.
        """
        self.shapes = tuple(shapes)
        super().__init__(shape.hull for shape in self.shapes)

    def __iter__(self) -> Iterator[Obstacle]:
        """Iterate over the obstacles."""
        return iter(self.shapes)

    def __eq__(self, other: object) -> bool:
        """Return whether both hold equal obstacles in the same order."""
        return isinstance(other, ObstacleSet) and self.shapes == other.shapes

    def __hash__(self) -> int:
        """Return the hash of the obstacles."""
        return hash(self.shapes)

    def __repr__(self) -> str:
        """Return the obstacles as text."""
        return f"ObstacleSet({self.shapes})"

    @cached_property
    def packed(self) -> PackedObstacles:
        """The obstacles as arrays for compiled loops."""
        lengths = np.hypot(self.edges[:, 0], self.edges[:, 1])
        edges = np.column_stack(
            [self.normals, self.offsets, self.points, lengths]
        )
        sides = lengths > 0.0
        counts = np.bincount(self.hull_of_edge[sides], minlength=len(self))
        firsts = np.cumsum([0, *counts])
        return PackedObstacles(self.circles, firsts, edges[sides])


NO_OBSTACLES = ObstacleSet()
"""Obstacle set of an open floor."""
