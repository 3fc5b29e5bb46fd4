"""Shapes on the floor: discs, boxes and convex polygons."""

from dataclasses import dataclass
from functools import cached_property
from math import cos, hypot, sin, tau
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.convex import convex_hull
from ..core.errors import check_bearing, check_within
from ..core.poses import Array, Pose, wrap_angle
from .hull_set import RoundedHull, rounded_hull
from .obstacles import Obstacle
from .polygon_checks import (
    ERROR,
    FARTHEST,
    SMALLEST,
    check_convex,
    check_coordinate,
    parse_corners,
)

WALL = 0.1  # thickness of a wall, in [m]
CIRCLE_CORNERS = 72  # of the polygon that a disc is drawn as


@dataclass(frozen=True)
class Disc(Obstacle):
    """Round obstacle: a pillar, a bin; in the frame of its room or map.

    Attributes:
        x: x of its centre, in [m].
        y: y of its centre, in [m].
        radius: Radius, in [m].
    """

    x: float
    y: float
    radius: float

    kind: ClassVar[str] = "disc"

    def __post_init__(self) -> None:
        """Validate centre and radius."""
        check_coordinate(self.x, "disc x")
        check_coordinate(self.y, "disc y")
        check_within(
            self.radius, SMALLEST, FARTHEST, "disc radius", "m", ERROR
        )

    @cached_property
    def hull(self) -> RoundedHull:
        """The centre, grown by the radius."""
        return rounded_hull([(self.x, self.y)], self.radius)

    @property
    def outline(self) -> Array:
        """Points on the circle, in [m]. Shape (72, 2)."""
        angles = np.arange(CIRCLE_CORNERS) * (tau / CIRCLE_CORNERS)
        ring = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        outline: Array = self.points + self.radius * ring
        return outline

    def moved(self, pose: Pose) -> "Disc":
        """Take the disc out of a frame with a pose in the parent frame."""
        moved = pose.compose(Pose(self.x, self.y, 0.0))
        return Disc(moved.x, moved.y, self.radius)


@dataclass(frozen=True)
class Polygon(Obstacle):
    """Convex polygonal obstacle: a table.

    Attributes:
        corners: Corners (x, y) in the frame of its room or map, in order
            along the edge, in [m]; stored counter-clockwise.
    """

    corners: tuple[tuple[float, float], ...]

    kind: ClassVar[str] = "polygon"

    def __post_init__(self) -> None:
        """Validate that the polygon is simple, convex and not degenerate."""
        corners = check_convex(parse_corners(self.corners))
        object.__setattr__(self, "corners", corners)

    @cached_property
    def hull(self) -> RoundedHull:
        """The corners, without a radius."""
        return rounded_hull(self.corners)

    def moved(self, pose: Pose) -> "Polygon":
        """Take the polygon out of a frame with a pose in the parent frame."""
        moved = pose.transform_points(self.points).tolist()
        return Polygon(tuple((x, y) for x, y in moved))


@dataclass(frozen=True)
class Box(Obstacle):
    """Rectangular obstacle: a crate, a wall.

    Attributes:
        x: x of its centre in the frame of its room or map, in [m].
        y: y of its centre in the same frame, in [m].
        width: Side along its heading, in [m].
        depth: Side across its heading, in [m].
        heading: Direction of its width, in [rad].
    """

    x: float
    y: float
    width: float
    depth: float
    heading: float = 0.0

    kind: ClassVar[str] = "box"

    def __post_init__(self) -> None:
        """Validate centre, sides, heading and corners."""
        check_coordinate(self.x, "box x")
        check_coordinate(self.y, "box y")
        check_within(self.width, SMALLEST, FARTHEST, "box width", "m", ERROR)
        check_within(self.depth, SMALLEST, FARTHEST, "box depth", "m", ERROR)
        check_bearing(self.heading, "box heading", ERROR)
        for name, values in zip("xy", self.points.T.tolist(), strict=True):
            for value in values:
                check_coordinate(value, f"box corner {name}")

    @cached_property
    def hull(self) -> RoundedHull:
        """The four corners, without a radius."""
        c, s = cos(self.heading), sin(self.heading)
        corners = []
        for along, across in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            u, v = 0.5 * along * self.width, 0.5 * across * self.depth
            corners.append((self.x + c * u - s * v, self.y + s * u + c * v))
        return rounded_hull(corners)

    @property
    def centre(self) -> tuple[float, float]:
        """Centre (x, y), in [m]."""
        return self.x, self.y

    def moved(self, pose: Pose) -> "Box":
        """Take the box out of a frame with a pose in the parent frame."""
        x, y, heading = pose.compose(Pose(self.x, self.y, self.heading))
        return Box(x, y, self.width, self.depth, wrap_angle(heading))


def wall_between(
    start: tuple[float, float],
    end: tuple[float, float],
    thickness: float = WALL,
) -> Box:
    """Return the wall whose centre line runs from one point to another.

    Args:
        start: First end (x, y) of the centre line in the room, in [m].
        end: Second end (x, y) of the centre line in the room, in [m].
        thickness: Thickness, in [m].

    Raises:
        ConfigurationError: If a value is out of its range.
    """
    for name, (x, y) in (("start", start), ("end", end)):
        check_coordinate(x, f"wall {name} x")
        check_coordinate(y, f"wall {name} y")
    check_within(thickness, SMALLEST, FARTHEST, "wall thickness", "m", ERROR)
    along = np.subtract(end, start)
    length = hypot(*along)
    check_within(length, SMALLEST, FARTHEST, "wall length", "m", ERROR)
    heading = float(np.arctan2(along[1], along[0]))
    x, y = 0.5 * np.add(start, end)
    return Box(float(x), float(y), length, thickness, heading)


def hull(points: ArrayLike) -> Polygon:
    """Return the convex hull of points.

    Args:
        points: Points (x, y) in the frame of the polygon, in [m]. Shape
            (n, 2).

    Raises:
        ConfigurationError: If they are collinear.
    """
    corners = convex_hull(np.asarray(points, dtype=np.float64), 1e-12)
    return Polygon(tuple((x, y) for x, y in corners.tolist()))
