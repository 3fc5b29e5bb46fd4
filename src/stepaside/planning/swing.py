"""Swing-foot trajectories that lift off and touch down at rest."""

from typing import Literal

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
"""Fraction of the way by powers of the phase."""


def swing_progress(
    phase: ArrayLike, profile: SwingProfile = "minimum-jerk"
) -> Array:
    """Fraction of the way that a swing foot has made.

    Velocity and acceleration vanish at both ends. The minimum-jerk
    polynomial is fastest half-way, at 15/8 of the mean; the even one is as
    flat there as a polynomial of its degree can be, and goes at 35/24 of it.

    Args:
        phase: Fraction of single support that has passed; before 0 the foot
            stands where it was, after 1 where it lands. Shape (n,).
        profile: Which of the two.

    Returns:
        Fraction in [0, 1]. Shape (n,).
    """
    s = np.clip(np.asarray(phase, dtype=np.float64), 0.0, 1.0)
    if profile == "even":
        # From the nearer end: the sum of the powers is 1 but for rounding.
        near = np.minimum(s, 1.0 - s)
        part = np.polynomial.polynomial.polyval(near, _PROGRESS[profile])
        even: Array = np.where(s > 0.5, 1.0 - part, part)
        return even
    progress: Array = s**3 * (10.0 + s * (6.0 * s - 15.0))
    return progress


def swing_acceleration(profile: SwingProfile) -> Array:
    """Second derivative of the progress, by powers of the phase.

    Args:
        profile: See :func:`swing_progress`.

    Returns:
        Coefficients, the constant first. Shape (degree + 1,).
    """
    progress = np.array(_PROGRESS[profile], dtype=np.float64)
    powers = np.arange(progress.size)
    bent: Array = (progress * powers * (powers - 1))[2:]
    return bent


def swing_height(
    phase: ArrayLike, apex: float, profile: SwingProfile = "minimum-jerk"
) -> Array:
    """Height of a swing foot over the floor, in [m].

    The apex is reached half-way. Velocity vanishes at lift-off and
    touch-down; so does acceleration with the minimum-jerk profile, while
    the even one rises more slowly instead.

    Args:
        phase: Fraction of single support that has passed. Shape (n,).
        apex: Greatest height, in [m].
        profile: See :func:`swing_progress`.

    Returns:
        Heights. Shape (n,).
    """
    s = np.clip(np.asarray(phase, dtype=np.float64), 0.0, 1.0)
    power = 2 if profile == "even" else 3
    height: Array = apex * (4.0 * s * (1.0 - s)) ** power
    return height
