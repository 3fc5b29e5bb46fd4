"""Relative motion of two players, extrapolated at constant velocity."""

from math import hypot, isfinite, sqrt
from typing import NamedTuple

MIN_CLOSING_SPEED = 0.01  # below, a distance counts as constant, in [m/s]


class CourseApproach(NamedTuple):
    """Motion of one player relative to another, at constant velocity.

    Attributes:
        offset: Position of one player relative to the other now, in world
            axes (x, y), in [m].
        velocity: Rate of change of the offset, in [m/s].
    """

    offset: tuple[float, float]
    velocity: tuple[float, float]

    @property
    def speed(self) -> float:
        """Closing speed, in [m/s]; negative if the distance grows."""
        distance = hypot(*self.offset)
        return -self._inner / distance if distance > 0.0 else 0.0

    @property
    def is_approaching(self) -> bool:
        """Whether the distance falls."""
        return self.speed > MIN_CLOSING_SPEED

    @property
    def is_leaving(self) -> bool:
        """Whether the distance grows."""
        return self.speed < -MIN_CLOSING_SPEED

    @property
    def closest(self) -> float:
        """Closest approach from now on at this velocity, in [m]."""
        along = self._inner / max(hypot(*self.velocity), 1e-12)
        distance = hypot(*self.offset)
        if along >= 0.0:
            return distance
        return sqrt(max(0.0, distance**2 - along**2))

    def time_to(self, radius: float) -> float | None:
        """Compute the time until the distance equals a radius.

        Args:
            radius: In [m].

        Returns:
            Time, in [s]; None if the distance never falls to the radius.
        """
        distance = hypot(*self.offset)
        if distance <= radius:
            return 0.0
        if self.speed <= 0.0 or self.closest > radius:
            return None
        # |offset + velocity t| = radius, the earlier root.
        square = sum(v * v for v in self.velocity)
        inner = -self._inner
        root = sqrt(max(0.0, inner**2 - square * (distance**2 - radius**2)))
        return (distance**2 - radius**2) / (inner + root)

    @property
    def _inner(self) -> float:
        (x, y), (vx, vy) = self.offset, self.velocity
        return x * vx + y * vy


def describe_motion(approach: CourseApproach | None) -> str:
    """Return "approaches", "moves away" or "walks" for a pursuer."""
    if approach is not None and approach.is_approaching:
        return "approaches"
    if approach is not None and approach.is_leaving:
        return "moves away"
    return "walks"


def estimate_approach(
    before: tuple[float, float], now: tuple[float, float], elapsed: float
) -> CourseApproach | None:
    """Estimate an approach from two offsets, best a gait cycle apart.

    Args:
        before: Earlier offset from one player to the other (x, y), in [m].
        now: Present offset.
        elapsed: Time between the two, in [s].

    Returns:
        The approach; None if an offset is not finite or zero, or no time
        has elapsed.
    """
    if not elapsed > 0.0 or not all(map(isfinite, (*before, *now))):
        return None
    (x, y), (was_x, was_y) = now, before
    distance = hypot(x, y)
    if distance == 0.0:
        return None
    # The chord of a turn about the opponent has an outward component.
    # Therefore the radial rate is taken from the distances, and only the
    # transverse rate from the chord.
    rate = (distance - hypot(was_x, was_y)) / elapsed
    across = (x * (y - was_y) - y * (x - was_x)) / (distance * elapsed)
    radial = x / distance, y / distance
    transverse = -y / distance, x / distance
    vx, vy = (
        rate * a + across * b for a, b in zip(radial, transverse, strict=True)
    )
    return CourseApproach((x, y), (vx, vy))
