"""Rotations: matrices, quaternions (w, x, y, z), roll, pitch and yaw."""

from collections.abc import Sequence
from math import asin, atan2, cos, hypot, nan, sin

import numpy as np

from .poses import Array


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """Return Rz(yaw) Ry(pitch) Rx(roll), angles in [rad]. Shape (3, 3)."""
    cr, sr, cp, sp = cos(roll), sin(roll), cos(pitch), sin(pitch)
    cy, sy = cos(yaw), sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def angles_of(axes: Array) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a rotation; see :func:`rotation`."""
    (xx, xy, _), (yx, yy, _), (zx, zy, zz) = axes.tolist()
    pitch = asin(max(min(-zx, 1.0), -1.0))
    if abs(zx) > 1.0 - 1e-12:  # roll and yaw are about one axis
        return 0.0, pitch, atan2(-xy, yy)
    return atan2(zy, zz), pitch, atan2(yx, xx)


def rotation_about(axis: Sequence[float] | Array, angle: float) -> Array:
    """Return the rotation by an angle, in [rad], about a unit axis (3, 3)."""
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: Array = np.eye(3) + sin(angle) * across
    turned += (1.0 - cos(angle)) * (across @ across)
    return turned


def rotation_of(quaternion: Sequence[float] | Array) -> Array:
    """Return the rotation of a quaternion of any length. Shape (3, 3).

    It is NaN if the quaternion is zero or not finite.
    """
    norm = hypot(*quaternion)
    if not 0.0 < norm < np.inf:
        return np.full((3, 3), nan)
    w, *vector = (part / norm for part in quaternion)
    x, y, z = vector
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned: Array = np.eye(3) + 2.0 * w * across + 2.0 * (across @ across)
    return turned


def quaternion_of(
    roll: float, pitch: float, yaw: float
) -> tuple[float, float, float, float]:
    """Return the unit quaternion of :func:`rotation`."""
    cr, sr = cos(0.5 * roll), sin(0.5 * roll)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    cy, sy = cos(0.5 * yaw), sin(0.5 * yaw)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
