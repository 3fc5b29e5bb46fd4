"""Validation of the corners of polygons."""

from math import atan2, hypot, tau

from ..core.errors import ConfigurationError

SMALLEST = 1e-3  # least radius or edge, in [m]
Corners = tuple[tuple[float, float], ...]


def check_convex(corners: Corners) -> Corners:
    """Return the corners of a convex polygon, counter-clockwise.

    The exterior angles of a polygon that does not cross itself add up to one
    turn; those of a convex one have the same sign.

    Args:
        corners: Corners (x, y) in order along the edge, in [m].

    Raises:
        ConfigurationError: If the polygon crosses itself, is not convex, or
            has no inside.
    """
    edges = [
        (after[0] - before[0], after[1] - before[1])
        for before, after in zip(
            corners, (*corners[1:], corners[0]), strict=True
        )
    ]
    pairs = list(zip(edges, (*edges[1:], edges[0]), strict=True))
    crosses = [a * d - b * c for (a, b), (c, d) in pairs]
    dots = [a * c + b * d for (a, b), (c, d) in pairs]
    turns = round(sum(map(atan2, crosses, dots)) / tau)
    if abs(turns) != 1:
        raise _refusal("not cross itself", corners)
    lengths = [hypot(*edge) for edge in edges]
    longest = max(lengths)
    if min(lengths) < SMALLEST:
        raise _refusal(f"have edges >= {SMALLEST:g} [m]", corners)
    if min(turns * cross for cross in crosses) < -1e-9 * longest**2:
        raise _refusal("be convex", corners)
    x, y = corners[0]
    doubled = sum(
        (u - x) * b - (v - y) * a
        for (u, v), (a, b) in zip(corners, edges, strict=True)
    )
    if turns * doubled < SMALLEST * longest:
        raise _refusal("have an inside", corners)
    return corners if turns > 0 else corners[::-1]


def _refusal(rule: str, corners: Corners) -> ConfigurationError:
    """Return the error for a rule that a polygon breaks."""
    text = ", ".join(f"({x:g}, {y:g})" for x, y in corners)
    text = text if len(text) <= 80 else f"{text[:77]}..."
    return ConfigurationError(f"polygon must {rule}, got corners {text}")
