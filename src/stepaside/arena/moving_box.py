"""Boxes that move back and forth along a line."""

from dataclasses import dataclass
from math import hypot

import numpy as np

from ..core.errors import ConfigurationError
from ..core.ranges import Range
from ..core.setting import REQUIRED, check_settings, setting
from .shapes import BEARING, COORDINATE, SIDE, Box, Point, Polygon, hull


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
