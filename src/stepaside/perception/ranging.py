"""Distance from the apparent size of what is known."""

from math import hypot

from ..core.poses import Array
from .colour_detector import Appearance

FORWARD = 0.05  # how far the lower end stands before the axis, in [m]
BREADTH = 0.25  # of trim, seen aslant, in [m]
NEAREST, FARTHEST = 0.2, 4.0  # distances that trim can tell, in [m]


def range_of_trim(
    upper: Array, lower: Array, eye: float, appearance: Appearance
) -> float | None:
    """Distance of a robot's axis from the two ends of its trim.

    The difference of the slopes at which they are seen tells it; the
    height of the eye matters little.

    Args:
        upper: Direction of the upper end in a level frame. Shape (3,).
        lower: Direction of the lower end. Shape (3,).
        eye: Height of the camera above the floor, in [m].
        appearance: The heights of the ends.

    Returns:
        Horizontal distance from the camera, in [m]; None if the ends make
        no sense.
    """
    rise = upper[2] / hypot(upper[0], upper[1])
    span = rise - lower[2] / hypot(lower[0], lower[1])
    above, below = appearance.top - eye, eye - appearance.bottom
    if span <= 0.05:
        return None
    away = (above + below) / span
    for _ in range(4):
        rest = span - above / max(away, NEAREST)
        if rest <= 0.0:
            return None
        away = FORWARD + below / rest
    return float(away) if NEAREST < away < FARTHEST else None


def range_of_breadth(breadth: float) -> float:
    """Rough distance of a robot from how broad its trim looks.

    Its trim is as broad as its shoulders from the front and half as broad
    from the side: this is off by a third.

    Args:
        breadth: Angle from its left to its right end, in [rad].
    """
    return min(max(BREADTH / max(breadth, 1e-3), NEAREST), FARTHEST)
