"""Things that stand on the floor: discs and convex polygons."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..errors import check_within
from ..poses import Array, Pose
from .outline import (
    ERROR,
    FARTHEST,
    SMALLEST,
    area_of,
    check_coordinate,
    checked_corners,
    crosses_itself,
    told_corners,
)


@dataclass(frozen=True, slots=True)
class Disc:
    """A round thing: a pillar, a bin.

    Attributes:
        x: Of its centre, in [m].
        y: Of its centre, in [m].
        radius: In [m].
    """

    x: float
    y: float
    radius: float

    def __post_init__(self) -> None:
        """Refuse what is not finite, or no disc."""
        check_coordinate(self.x, "disc x")
        check_coordinate(self.y, "disc y")
        check_within(
            self.radius, SMALLEST, FARTHEST, "disc radius", "m", ERROR
        )

    @property
    def centre(self) -> tuple[float, float]:
        """Where its middle is, (x, y), in [m]."""
        return self.x, self.y

    def clearance(self, points: ArrayLike) -> Array:
        """Distance of points to its edge, negative inside.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Signed distances, in [m]. Shape (n,).
        """
        away = np.asarray(points, dtype=np.float64) - (self.x, self.y)
        found: Array = np.hypot(away[:, 0], away[:, 1]) - self.radius
        return found

    def moved(self, pose: Pose) -> "Disc":
        """The disc in the frame in which its own frame has a pose."""
        moved = pose.compose(Pose(self.x, self.y, 0.0))
        return Disc(moved.x, moved.y, self.radius)


@dataclass(frozen=True)
class Polygon:
    """A convex thing with corners: a box, a wall, a table.

    Attributes:
        corners: Corners (x, y), in [m], one after the other along the
            edge; kept counter-clockwise, whichever way they are given.
    """

    corners: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        """Refuse what crosses itself, is not convex or has no inside."""
        corners = checked_corners(self.corners)
        points = np.array(corners)
        if crosses_itself(points):
            raise ERROR(
                "polygon must not cross itself, got corners "
                f"{told_corners(corners)}"
            )
        if area_of(points) < 0.0:
            corners, points = corners[::-1], points[::-1]
        edges = np.roll(points, -1, axis=0) - points
        lengths = np.hypot(edges[:, 0], edges[:, 1])
        if lengths.min() < SMALLEST:
            raise ERROR(
                f"polygon must have edges >= {SMALLEST:g} [m], got corners "
                f"{told_corners(corners)}"
            )
        after = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
        if turns.min() < -1e-9 * lengths.max() ** 2:
            raise ERROR(
                f"polygon must be convex, got corners {told_corners(corners)}"
            )
        if area_of(points) < 0.5 * SMALLEST * lengths.max():
            raise ERROR(
                "polygon must have an inside, got corners "
                f"{told_corners(corners)}"
            )
        object.__setattr__(self, "corners", corners)

    @cached_property
    def points(self) -> Array:
        """Corners, counter-clockwise, in [m], read-only. Shape (m, 2)."""
        points = np.array(self.corners)
        points.setflags(write=False)
        return points

    @cached_property
    def normals(self) -> Array:
        """Outward unit normals of the edges, read-only. Shape (m, 2)."""
        edges = np.roll(self.points, -1, axis=0) - self.points
        normals = np.stack([edges[:, 1], -edges[:, 0]], axis=-1)
        normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
        normals.setflags(write=False)
        return normals

    @cached_property
    def offsets(self) -> Array:
        """Inside is ``normals @ p <= offsets``, in [m]. Shape (m,)."""
        offsets: Array = (self.normals * self.points).sum(axis=1)
        offsets.setflags(write=False)
        return offsets

    @property
    def centre(self) -> tuple[float, float]:
        """Mean of its corners, which lies inside, (x, y), in [m]."""
        x, y = self.points.mean(axis=0).tolist()
        return x, y

    @property
    def area(self) -> float:
        """Floor that it covers, in [m^2]."""
        return area_of(self.points)

    def clearance(self, points: ArrayLike) -> Array:
        """Distance of points to its edge, negative inside.

        Args:
            points: Points (x, y), in [m]. Shape (n, 2).

        Returns:
            Signed distances, in [m]. Shape (n,).
        """
        asked = np.asarray(points, dtype=np.float64)
        beyond = (asked @ self.normals.T - self.offsets).max(axis=1)
        edges = np.roll(self.points, -1, axis=0) - self.points
        away = asked[:, None, :] - self.points
        along = (away * edges).sum(axis=2) / (edges**2).sum(axis=1)
        away -= np.clip(along, 0.0, 1.0)[:, :, None] * edges
        nearest = np.hypot(away[:, :, 0], away[:, :, 1]).min(axis=1)
        found: Array = np.where(beyond <= 0.0, beyond, nearest)
        return found

    def moved(self, pose: Pose) -> "Polygon":
        """The polygon in the frame in which its own frame has a pose."""
        moved = pose.transform_points(self.points).tolist()
        return Polygon(tuple((x, y) for x, y in moved))
