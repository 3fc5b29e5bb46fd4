"""Approach of a pursuer, in words and from its positions."""

from math import hypot, isfinite

from ..strategies.approach import Approach

LEAST = 0.01  # closing speed below which a distance is constant, in [m/s]


def describe_motion(approach: Approach | None) -> str:
    """Return "approaches", "moves away" or "walks" for a pursuer."""
    speed = 0.0 if approach is None else approach.closing_speed
    if speed > LEAST:
        return "approaches"
    if speed < -LEAST:
        return "moves away"
    return "walks"


def estimate_approach(
    before: tuple[float, float], now: tuple[float, float], elapsed: float
) -> Approach | None:
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
    return Approach(x, y, vx, vy)
