"""What a sighting that comes from outside may say."""

from math import degrees, isfinite, pi

FARTHEST = 1e3  # distance beyond which there is nobody to see, in [m]
ROUNDING = 1e-6  # of a bearing in single precision, in [rad]


def fault_of(bearing: float, distance: float) -> str:
    """Return what is wrong with a sighting; empty if nothing is.

    An angle out of its range is not wrapped: whoever sends one may mean
    degrees, or another zero.

    Args:
        bearing: As it was sent, in [rad].
        distance: Likewise, in [m].
    """
    if not (isfinite(bearing) and isfinite(distance)):
        return "the sighting holds what is no number"
    if abs(bearing) > pi + ROUNDING:
        return (
            "the bearing of the sighting must lie in [-180, 180] deg, got "
            f"{degrees(bearing):.0f} deg ({bearing:.3f} rad)"
        )
    if not 0.0 <= distance <= FARTHEST:
        return (
            f"the distance of the sighting must lie in [0, {FARTHEST:g}] m, "
            f"got {distance:g} m"
        )
    return ""
