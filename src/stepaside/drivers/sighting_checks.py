"""Validation of sightings that are received from other programs."""

from math import degrees, isfinite, pi

MAX_DISTANCE = 1e3  # far beyond the range of any sensor used, in [m]
ROUNDING = 1e-6  # of a bearing in single precision, in [rad]


def sighting_fault(bearing: float, distance: float) -> str:
    """Return the reason why a sighting is invalid; empty if it is valid.

    A bearing out of range is not wrapped: the sender may use degrees, or
    another zero direction.

    Args:
        bearing: Received bearing, in [rad].
        distance: Received distance, in [m].
    """
    if not (isfinite(bearing) and isfinite(distance)):
        return (
            "bearing and distance of the sighting must be finite, got "
            f"{bearing} rad and {distance} m"
        )
    if abs(bearing) > pi + ROUNDING:
        return (
            "the bearing of the sighting must lie in [-180, 180] deg, got "
            f"{degrees(bearing):.0f} deg ({bearing:.3f} rad)"
        )
    if not 0.0 <= distance <= MAX_DISTANCE:
        return (
            "the distance of the sighting must lie in "
            f"[0, {MAX_DISTANCE:g}] m, got {distance:g} m"
        )
    return ""
