"""Swing-foot trajectories that lift off and touch down at rest."""

import numpy as np
from numpy.typing import ArrayLike

from ..poses import Array


def swing_progress(phase: ArrayLike) -> Array:
    """Fraction of the way that a swing foot has made.

    The minimum-jerk polynomial: velocity and acceleration vanish at both
    ends.

    Args:
        phase: Fraction of single support that has passed; before 0 the foot
            stands where it was, after 1 where it lands. Shape (n,).

    Returns:
        Fraction in [0, 1]. Shape (n,).
    """
    s = np.clip(np.asarray(phase, dtype=np.float64), 0.0, 1.0)
    progress: Array = s**3 * (10.0 + s * (6.0 * s - 15.0))
    return progress


def swing_height(phase: ArrayLike, apex: float) -> Array:
    """Height of a swing foot over the floor, in [m].

    Velocity and acceleration vanish at lift-off and touch-down, and the
    apex is reached half-way.

    Args:
        phase: Fraction of single support that has passed. Shape (n,).
        apex: Greatest height, in [m].

    Returns:
        Heights. Shape (n,).
    """
    s = np.clip(np.asarray(phase, dtype=np.float64), 0.0, 1.0)
    height: Array = apex * (4.0 * s * (1.0 - s)) ** 3
    return height
