"""How one player approaches another, extrapolated in a straight line."""

from math import hypot, isfinite, sqrt
from typing import NamedTuple

SLOWEST = 0.01  # below, a distance counts as constant, in [m/s]


class CourseApproach(NamedTuple):
    """Motion of one player relative to another, at constant velocity.

    Attributes:
        offset: From one to the other now, in the world, in [m].
        velocity: Rate of change of the offset, in [m/s].
    """

    offset: tuple[float, float]
    velocity: tuple[float, float]

    @property
    def speed(self) -> float:
        """Rate at which the distance falls, in [m/s]; negative if it grows."""
        away = hypot(*self.offset)
        return -self._inner / away if away > 0.0 else 0.0

    @property
    def is_approaching(self) -> bool:
        """Whether the distance falls."""
        return self.speed > SLOWEST

    @property
    def is_leaving(self) -> bool:
        """Whether the distance grows."""
        return self.speed < -SLOWEST

    @property
    def closest(self) -> float:
        """Closest approach from now on, on this course, in [m]."""
        along = self._inner / max(hypot(*self.velocity), 1e-12)
        away = hypot(*self.offset)
        return away if along >= 0.0 else sqrt(max(0.0, away**2 - along**2))

    def time_to(self, radius: float) -> float | None:
        """Time until the distance is a radius, in [s]; None if never.

        Args:
            radius: In [m].
        """
        away = hypot(*self.offset)
        if away <= radius:
            return 0.0
        if self.speed <= 0.0 or self.closest > radius:
            return None
        # |offset + velocity t| = radius, the earlier root.
        square = sum(v * v for v in self.velocity)
        inner = -self._inner
        root = sqrt(max(0.0, inner**2 - square * (away**2 - radius**2)))
        return (away**2 - radius**2) / (inner + root)

    @property
    def _inner(self) -> float:
        (x, y), (vx, vy) = self.offset, self.velocity
        return x * vx + y * vy


def motion_words(approach: CourseApproach | None) -> str:
    """Say how a pursuer moves: "comes", "moves away" or "walks"."""
    if approach is not None and approach.is_approaching:
        return "comes"
    if approach is not None and approach.is_leaving:
        return "moves away"
    return "walks"


def approach_between(
    before: tuple[float, float], now: tuple[float, float], elapsed: float
) -> CourseApproach | None:
    """Estimate an approach from two offsets, best a gait cycle apart.

    Args:
        before: Offset from one player to the other then, in [m].
        now: The same now.
        elapsed: Time from then to now, in [s].

    Returns:
        The approach; None if it cannot be told.
    """
    if not elapsed > 0.0 or not all(map(isfinite, (*before, *now))):
        return None
    (x, y), (was_x, was_y) = now, before
    away = hypot(x, y)
    if away == 0.0:
        return None
    # The chord of a turn about the other points outward: the rate of the
    # distance is taken from the distances, what is across from the chord.
    rate = (away - hypot(was_x, was_y)) / elapsed
    across = (x * (y - was_y) - y * (x - was_x)) / (away * elapsed)
    ahead, aside = (x / away, y / away), (-y / away, x / away)
    vx, vy = (rate * a + across * b for a, b in zip(ahead, aside, strict=True))
    return CourseApproach((x, y), (vx, vy))
