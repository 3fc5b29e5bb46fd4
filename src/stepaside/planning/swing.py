"""Swing-foot trajectories with zero velocity at lift-off and touch-down."""

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..core.poses import Array

SwingProfile = Literal["minimum-jerk", "even"]

_PROGRESS: dict[SwingProfile, tuple[float, ...]] = {
    "minimum-jerk": (0.0, 0.0, 0.0, 10.0, -15.0, 6.0),
    "even": tuple(
        70.0 / 3.0 * c for c in (0.0, 0.0, 0.0, 1.0, -3.5, 5.4, -4.0, 8.0 / 7)
    ),
}
"""Coefficients of the progress, by powers of the phase."""


def swing_progress(phase: Any, profile: SwingProfile = "minimum-jerk") -> Any:
    """Return the fraction of the path that a swing foot has covered.

    Velocity and acceleration vanish at both ends. The minimum-jerk polynomial
    peaks half-way at 15/8 of the mean velocity, the even one at 35/24.
    """
    if isinstance(phase, float):
        s = min(max(phase, 0.0), 1.0)
    else:
        s = np.clip(phase, 0.0, 1.0)
    if profile == "minimum-jerk":
        return s**3 * (10.0 + s * (6.0 * s - 15.0))
    # From the nearer end: the coefficients sum to 1 only up to rounding.
    near, part = 0.5 - abs(s - 0.5), 0.0 * s
    for coefficient in reversed(_PROGRESS[profile]):
        part = coefficient + part * near
    return part + (s > 0.5) * (1.0 - 2.0 * part)


def swing_acceleration(profile: SwingProfile) -> Array:
    """Return the second derivative of the progress, by powers of the phase."""
    progress = np.array(_PROGRESS[profile], dtype=np.float64)
    powers = np.arange(progress.size)
    acceleration: Array = (progress * powers * (powers - 1))[2:]
    return acceleration


def swing_height(
    phase: ArrayLike, apex: float, profile: SwingProfile = "minimum-jerk"
) -> Array:
    """Return the height of a swing foot over the floor, in [m]. Shape (n,).

    The apex is half-way. The even profile has a lower vertical velocity.
    """
    s = np.clip(np.asarray(phase, dtype=np.float64), 0.0, 1.0)
    power = 2 if profile == "even" else 3
    height: Array = apex * (4.0 * s * (1.0 - s)) ** power
    return height
