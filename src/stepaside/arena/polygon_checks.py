"""Validation of coordinates and of the corners of polygons."""

from collections.abc import Sequence

import numpy as np

from ..core.errors import ConfigurationError, check_finite, check_within
from ..core.poses import Array

ERROR = ConfigurationError
FARTHEST = 1000.0  # largest magnitude of a coordinate, in [m]
SMALLEST = 1e-3  # least radius or edge, in [m]
MOST_CORNERS = 64


def check_coordinate(value: float, name: str) -> None:
    """Raise unless a coordinate in [m] is finite and within 1000 m."""
    check_finite(value, name, "m", ERROR)
    check_within(value, -FARTHEST, FARTHEST, name, "m", ERROR)


def parse_corners(corners: object) -> tuple[tuple[float, float], ...]:
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


def crosses_itself(points: Array) -> bool:
    """Return whether two edges that are not adjacent intersect."""
    count = len(points)
    for i in range(count):
        for j in range(i + 2, count):
            if (j + 1) % count == i:
                continue
            a, b = points[i], points[(i + 1) % count]
            c, d = points[j], points[(j + 1) % count]
            if _side(a, b, c) * _side(a, b, d) <= 0.0 and (
                _side(c, d, a) * _side(c, d, b) <= 0.0
            ):
                return True
    return False


def _side(a: Array, b: Array, p: Array) -> float:
    turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
    return float(np.sign(turn))


def format_corners(corners: tuple[tuple[float, float], ...]) -> str:
    """Return the corners as text for a message, 80 characters at most."""
    text = ", ".join(f"({x:g}, {y:g})" for x, y in corners)
    return text if len(text) <= 80 else f"{text[:77]}..."
