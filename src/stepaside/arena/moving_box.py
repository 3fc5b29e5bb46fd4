"""Boxes that somebody pushes to and fro."""

from dataclasses import dataclass
from math import hypot

import numpy as np

from ..core.errors import check_within
from .polygon_checks import ERROR, check_coordinate
from .shapes import Box, Polygon, hull

FASTEST = 0.2  # of a box that robots can keep clear of, in [m/s]


@dataclass(frozen=True, slots=True)
class MovingBox:
    """A box that is pushed to a place and back, again and again.

    It moves straight, at one speed, and does not turn.

    Attributes:
        x: Of its centre at first, in [m].
        y: Of its centre at first, in [m].
        width: Along its heading, in [m].
        depth: Across its heading, in [m].
        to: Where its centre moves to, (x, y), in [m].
        speed: In [m/s].
        heading: Of its width, in [rad].
    """

    x: float
    y: float
    width: float
    depth: float
    to: tuple[float, float]
    speed: float = 0.05
    heading: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is no box, and what moves too fast or nowhere."""
        if len(self.to) != 2:
            raise ERROR(
                f"moving box to must be a pair x, y [m], got {self.to!r:.40}"
            )
        for value, name in zip(self.to, ("to x", "to y"), strict=True):
            check_coordinate(value, f"moving box {name}")
        check_within(
            self.speed, 1e-3, FASTEST, "moving box speed", "m/s", ERROR
        )
        Box(self.x, self.y, self.width, self.depth, self.heading)
        if not self.length > 1e-3:
            raise ERROR(
                "moving box to must be at least 0.001 [m] from where it "
                f"stands, got {self.length:g}"
            )

    @property
    def length(self) -> float:
        """Of its way, in [m]."""
        return hypot(self.to[0] - self.x, self.to[1] - self.y)

    @property
    def ends(self) -> tuple[Box, Box]:
        """Floor that it covers at both ends of its way."""
        return self.at(0.0), self.at(self.length / self.speed)

    def place_at(self, time: float) -> tuple[float, float]:
        """Where its centre is at a time in [s], in [m]."""
        share = (self.speed * time / self.length) % 2.0
        share = min(share, 2.0 - share)
        return (
            self.x + share * (self.to[0] - self.x),
            self.y + share * (self.to[1] - self.y),
        )

    def at(self, time: float) -> Box:
        """Floor that it covers at a time, in [s]."""
        return Box(*self.place_at(time), self.width, self.depth, self.heading)

    def swept(self, begin: float, end: float) -> Polygon:
        """Floor that it covers from one time to another, in [s]."""
        times = [begin, end]
        # Where it turns back it is farther than at either end.
        half = self.length / self.speed
        turns = np.arange(np.ceil(begin / half), np.floor(end / half) + 1.0)
        times += (half * turns[:2]).tolist()
        return hull(np.concatenate([self.at(time).points for time in times]))
