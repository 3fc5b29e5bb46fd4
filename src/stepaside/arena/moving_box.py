"""Boxes that move back and forth along a line."""

from dataclasses import dataclass
from math import hypot

import numpy as np

from ..core.errors import check_within
from .polygon_checks import ERROR, check_coordinate
from .shapes import Box, Polygon, hull

MAX_SPEED = 0.2  # up to which robots can keep clear of a box, in [m/s]


@dataclass(frozen=True, slots=True)
class MovingBox:
    """Box that moves to a point and back, periodically.

    It moves along a straight line at constant speed and does not turn.

    Attributes:
        x: Initial x of its centre in the room, in [m].
        y: Initial y of its centre in the room, in [m].
        width: Side along its heading, in [m].
        depth: Side across its heading, in [m].
        to: Point (x, y) where its centre turns back, in [m].
        speed: Speed, in [m/s].
        heading: Direction of its width, in [rad].
    """

    x: float
    y: float
    width: float
    depth: float
    to: tuple[float, float]
    speed: float = 0.05
    heading: float = 0.0

    def __post_init__(self) -> None:
        """Validate the box, its speed and its path."""
        if len(self.to) != 2:
            raise ERROR(
                f"moving box to must be a pair x, y [m], got {self.to!r:.40}"
            )
        for value, name in zip(self.to, ("to x", "to y"), strict=True):
            check_coordinate(value, f"moving box {name}")
        check_within(
            self.speed, 1e-3, MAX_SPEED, "moving box speed", "m/s", ERROR
        )
        Box(self.x, self.y, self.width, self.depth, self.heading)
        if not self.length > 1e-3:
            raise ERROR(
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
