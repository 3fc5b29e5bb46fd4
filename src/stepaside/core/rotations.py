"""Rotation matrices."""

from collections.abc import Sequence

import numpy as np

from .poses import Array


def rotation_about(axis: Sequence[float], angle: float) -> Array:
    """Return the rotation by an angle, in [rad], about a unit axis.

    Shape (3, 3).
    """
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rest = 1.0 - np.cos(angle)
    turned: Array = np.eye(3) + np.sin(angle) * across
    turned += rest * (across @ across)
    return turned
