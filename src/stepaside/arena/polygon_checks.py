"""Validation of coordinates and of the corners of polygons."""

from collections.abc import Sequence
from math import atan2, hypot, tau

from ..core.errors import ConfigurationError, check_finite, check_within

ERROR = ConfigurationError
FARTHEST = 1000.0  # largest magnitude of a coordinate, in [m]
SMALLEST = 1e-3  # least radius or edge, in [m]
MOST_CORNERS = 64
Corners = tuple[tuple[float, float], ...]


def check_coordinate(value: float, name: str) -> None:
    """Raise unless a coordinate in [m] is finite and within 1000 m."""
    check_finite(value, name, "m", ERROR)
    check_within(value, -FARTHEST, FARTHEST, name, "m", ERROR)


def parse_corners(corners: object) -> Corners:
    """Return corners as pairs of finite numbers, or raise."""
    if not isinstance(corners, Sequence) or isinstance(corners, str):
        raise ERROR(f"polygon corners must be a list, got {corners!r:.40}")
    if not 3 <= len(corners) <= MOST_CORNERS:
        raise ERROR(
            f"polygon must have 3 to {MOST_CORNERS} corners [1], "
            f"got {len(corners)}"
        )
    for corner in corners:
        if not isinstance(corner, Sequence) or len(corner) != 2:
            raise ERROR(
                f"polygon corner must be a pair x, y [m], got {corner!r:.40}"
            )
        for name, value in zip("xy", corner, strict=True):
            if not isinstance(value, int | float):
                raise ERROR(
                    f"polygon corner {name} must be a number [m], "
                    f"got {value!r:.40}"
                )
            check_coordinate(value, f"polygon corner {name}")
    return tuple((float(x), float(y)) for x, y in corners)


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
    return ERROR(f"polygon must {rule}, got corners {text}")
