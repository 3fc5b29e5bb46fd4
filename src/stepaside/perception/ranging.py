"""Distance of a robot from the apparent size of its trim."""

from math import hypot

from ..core.poses import Array
from .colour_detector import Appearance

FORWARD = 0.05  # from the axis to the lower end of the trim, in [m]
WIDTH = 0.25  # of trim, seen obliquely, in [m]
# Range of distances from trim, in [m].
NEAREST = 0.2
FARTHEST = 4.0


def range_of_trim(
    upper: Array, lower: Array, camera_height: float, appearance: Appearance
) -> float | None:
    """Return the distance of a robot from the two ends of its trim.

    It follows from the difference of their slopes; the height of the camera
    has little influence.

    Args:
        upper: Ray to the upper end in a level frame. Shape (3,).
        lower: Ray to the lower end in a level frame. Shape (3,).
        camera_height: Height of the camera above the floor, in [m].
        appearance: Appearance with the heights of the ends.

    Returns:
        Horizontal distance from the camera to the axis of the robot, in [m];
        None if it is out of range.
    """
    rise = upper[2] / hypot(upper[0], upper[1])
    span = rise - lower[2] / hypot(lower[0], lower[1])
    above, below = (
        appearance.top - camera_height,
        camera_height - appearance.bottom,
    )
    if span <= 0.05:
        return None
    distance = (above + below) / span
    for _ in range(4):
        slope_below = span - above / max(distance, NEAREST)
        if slope_below <= 0.0:
            return None
        distance = FORWARD + below / slope_below
    return float(distance) if NEAREST < distance < FARTHEST else None


def range_of_width(angle: float) -> float:
    """Return a rough distance of a robot from the width of its trim, in [m].

    Trim is as wide as the shoulders from the front and half as wide from the
    side, so the error is up to a third.

    Args:
        angle: Angle from the left to the right end of the trim, in [rad].
    """
    return min(max(WIDTH / max(angle, 1e-3), NEAREST), FARTHEST)
