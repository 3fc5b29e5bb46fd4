"""Shapes on the floor: discs, boxes and convex polygons; moving boxes."""

from dataclasses import dataclass
from functools import cached_property
from math import hypot, tau
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.convex import convex_hull, next_corners, signed_area
from ..core.errors import ConfigurationError, shown
from ..core.poses import Array, Pose
from ..core.ranges import Range
from ..core.setting import REQUIRED, CheckedSettings, check_settings, setting
from .obstacles import Obstacle

SMALLEST = 1e-3  # least radius or edge, in [m]
FARTHEST = 1000.0  # largest coordinate or side, in [m]
COORDINATE = Range(-FARTHEST, FARTHEST, "m", "from the origin of the room")
SIDE = Range(SMALLEST, FARTHEST, "m", "from a pin to a hall")
BEARING = Range(-tau, tau, "rad", "a turn")
MOST_CORNERS = 64
Point = tuple[float, float]
WALL = 0.1  # thickness of a wall, in [m]
CIRCLE_CORNERS = 72  # of the polygon that a disc is drawn as


@dataclass(frozen=True)
class Disc(Obstacle, CheckedSettings, prefix="disc "):
    """Round obstacle: a pillar, a bin; in the frame of its room or map."""

    x: float = setting(REQUIRED, "x of its centre", COORDINATE)
    y: float = setting(REQUIRED, "y of its centre", COORDINATE)
    radius: float = setting(REQUIRED, "Radius", SIDE)

    kind: ClassVar[str] = "disc"

    @cached_property
    def points(self) -> Array:
        """The centre, in [m]. Shape (1, 2)."""
        return np.array([(self.x, self.y)])

    @property
    def rounding(self) -> float:
        """Radius, in [m]."""
        return self.radius

    @property
    def outline(self) -> Array:
        """Points on the circle, in [m]. Shape (72, 2)."""
        angles = np.arange(CIRCLE_CORNERS) * (tau / CIRCLE_CORNERS)
        ring = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        outline: Array = self.points + self.radius * ring
        return outline


@dataclass(frozen=True)
class Polygon(Obstacle):
    """Convex obstacle, with corners stored counter-clockwise: a table."""

    corners: tuple[Point, ...] = setting(
        REQUIRED,
        "Corners (x, y) in the frame of its room or map, in order along the "
        "edge",
        COORDINATE,
        count=(3, MOST_CORNERS),
    )

    kind: ClassVar[str] = "polygon"

    def __post_init__(self) -> None:
        check_settings(self, prefix="polygon ")
        object.__setattr__(self, "corners", check_convex(self.corners))

    @cached_property
    def points(self) -> Array:
        """The corners, in [m]. Shape (n, 2)."""
        return np.array(self.corners)


@dataclass(frozen=True)
class Box(Obstacle):
    """Rectangular obstacle in the frame of its room or map: a crate."""

    x: float = setting(REQUIRED, "x of its centre", COORDINATE)
    y: float = setting(REQUIRED, "y of its centre", COORDINATE)
    width: float = setting(REQUIRED, "Side along its heading", SIDE)
    depth: float = setting(REQUIRED, "Side across its heading", SIDE)
    heading: float = setting(0.0, "Direction of its width", BEARING)

    kind: ClassVar[str] = "box"

    def __post_init__(self) -> None:
        check_settings(self, prefix="box ")
        for value in self.points.ravel().tolist():
            COORDINATE.check(value, "box corner")

    @cached_property
    def points(self) -> Array:
        """The four corners, in [m]. Shape (4, 2)."""
        half = 0.5 * np.array([self.width, self.depth])
        corners = half * [(1, 1), (-1, 1), (-1, -1), (1, -1)]
        pose = Pose(self.x, self.y, self.heading)
        return pose.transform_points(corners)

    @property
    def centre(self) -> tuple[float, float]:
        """Centre (x, y), in [m]."""
        return self.x, self.y


def hull(points: ArrayLike) -> Polygon:
    """Return the convex hull of points (n, 2), which must not be collinear."""
    corners = convex_hull(np.asarray(points, dtype=np.float64), 1e-12)
    return Polygon(tuple((x, y) for x, y in corners.tolist()))


def check_convex(corners: tuple[Point, ...]) -> tuple[Point, ...]:
    """Return the corners of a convex polygon, counter-clockwise.

    The exterior angles of a polygon that does not cross itself add up to one
    turn; those of a convex one have the same sign.
    """
    points = np.array(corners)
    edges = next_corners(points) - points
    after = next_corners(edges)
    crosses = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
    angles = np.arctan2(crosses, (edges * after).sum(axis=1))
    turns = round(float(angles.sum()) / tau)
    lengths = np.hypot(edges[:, 0], edges[:, 1])
    longest, doubled = lengths.max(), 2.0 * turns * signed_area(points)
    for holds, rule in (
        (abs(turns) == 1, "not cross itself"),
        (lengths.min() >= SMALLEST, f"have edges >= {SMALLEST:g} [m]"),
        ((turns * crosses).min() >= -1e-9 * longest**2, "be convex"),
        (doubled >= SMALLEST * longest, "have an inside"),
    ):
        if not holds:
            raise ConfigurationError(
                f"polygon must {rule}, got corners {shown(corners)}"
            )
    return corners if turns > 0 else corners[::-1]


@dataclass(frozen=True, slots=True)
class MovingBox:
    """Box that moves to a point and back at constant speed, not turning."""

    x: float = setting(REQUIRED, "Initial x of its centre", COORDINATE)
    y: float = setting(REQUIRED, "Initial y of its centre", COORDINATE)
    width: float = setting(REQUIRED, "Side along its heading", SIDE)
    depth: float = setting(REQUIRED, "Side across its heading", SIDE)
    to: Point = setting(
        REQUIRED, "Point (x, y) where its centre turns back", COORDINATE
    )
    speed: float = setting(
        0.05,
        "Speed",
        Range(1e-3, 0.2, "m/s", "robots keep clear of a slow box"),
    )
    heading: float = setting(0.0, "Direction of its width", BEARING)

    def __post_init__(self) -> None:
        check_settings(self, prefix="moving box ")
        Box(self.x, self.y, self.width, self.depth, self.heading)
        if not self.length > 1e-3:
            raise ConfigurationError(
                "moving box to must be at least 0.001 [m] from x, y, "
                f"got {self.length:g}"
            )

    @property
    def length(self) -> float:
        """Length of its path, in [m]."""
        return hypot(self.to[0] - self.x, self.to[1] - self.y)

    @property
    def ends(self) -> tuple[Box, Box]:
        """Footprints at both ends of its path."""
        return self.at(0.0), self.at(self.length / self.speed)

    def place_at(self, time: float) -> tuple[float, float]:
        """Return the position of its centre at a time in [s], in [m]."""
        fraction = (self.speed * time / self.length) % 2.0
        fraction = min(fraction, 2.0 - fraction)
        return (
            self.x + fraction * (self.to[0] - self.x),
            self.y + fraction * (self.to[1] - self.y),
        )

    def at(self, time: float) -> Box:
        """Return its footprint at a time, in [s]."""
        return Box(*self.place_at(time), self.width, self.depth, self.heading)

    def swept(self, begin: float, end: float) -> Polygon:
        """Return the hull of its footprints between two times, in [s]."""
        times = [begin, end]
        # A turning point in between lies beyond both positions.
        half = self.length / self.speed
        turns = np.arange(np.ceil(begin / half), np.floor(end / half) + 1.0)
        times += (half * turns[:2]).tolist()
        return hull(np.concatenate([self.at(time).points for time in times]))
