"""Planar poses (x [m], y [m], theta [rad]) and angles."""

from collections.abc import Sequence
from math import cos, pi, remainder, sin, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Sector(NamedTuple):
    """Range of directions."""

    middle: float  # middle of the range, in [rad]
    half: float  # half of its width, in [rad]


ALL_AROUND = (Sector(0.0, pi),)


def in_sectors(
    sectors: Sequence[Sector], angles: ArrayLike
) -> NDArray[np.bool_]:
    """Return whether angles, in [rad], lie in any of several sectors."""
    angles = np.asarray(angles, dtype=np.float64)
    found = np.zeros(angles.shape, dtype=np.bool_)
    for middle, half in sectors:
        found |= np.abs(wrap_angles(angles - middle)) <= half
    return found


def wrap_angle(angle: float) -> float:
    """Wrap an angle to [-pi, pi], in [rad]."""
    return remainder(angle, tau)


def wrap_angles(angles: ArrayLike) -> Array:
    """Wrap angles to [-pi, pi), elementwise, in [rad]."""
    wrapped: Array = (np.asarray(angles, dtype=np.float64) + pi) % tau - pi
    return wrapped


def rotate(x: ArrayLike, y: ArrayLike, angle: ArrayLike) -> Array:
    """Turn vectors to the left by angles, in [rad]. Shape (2, ...)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y, s * x + c * y])


def arc(ahead: ArrayLike, left: ArrayLike, turn: ArrayLike) -> Array:
    """Return the poses after arcs of circles, eq. (9).

    A chord of an arc has length sinc(turn / 2) of the arc's and points along
    turn / 2; this form has no singularity at zero.
    Distances driven ahead and to the left, in [m], and turns, in [rad], are
    broadcast. Shape (..., 3), in the initial frame.
    """
    half = 0.5 * np.asarray(turn, dtype=np.float64)
    x, y = np.sinc(half / pi) * rotate(ahead, left, half)
    return np.stack([x, y, np.broadcast_to(2.0 * half, x.shape)], axis=-1)


class Pose(NamedTuple):
    """Pose of a frame in the plane, relative to a parent frame."""

    x: float  # along the parent's sagittal axis, in [m]
    y: float  # along the parent's coronal axis (left), in [m]
    theta: float  # heading, counter-clockwise, in [rad]

    def compose(self, child: "Pose") -> "Pose":
        """Return the pose in the parent frame of a pose in this frame."""
        c, s = cos(self.theta), sin(self.theta)
        return Pose(
            self.x + c * child.x - s * child.y,
            self.y + s * child.x + c * child.y,
            self.theta + child.theta,
        )

    def inverse(self) -> "Pose":
        """Return the pose of the parent frame in this frame."""
        c, s = cos(self.theta), sin(self.theta)
        return Pose(
            -c * self.x - s * self.y, s * self.x - c * self.y, -self.theta
        )

    def along_arc(self, way: float, turn: float) -> "Pose":
        """Return the pose after a way, in [m], and a turn; see :func:`arc`."""
        half = 0.5 * turn
        along = self.theta + half
        if abs(half) > 1e-8:
            way *= sin(half) / half
        return Pose(
            self.x + way * cos(along),
            self.y + way * sin(along),
            self.theta + turn,
        )

    def transform_points(self, points: ArrayLike) -> Array:
        """Transform points of this frame to the parent frame. Shape (n, 2)."""
        c, s = cos(self.theta), sin(self.theta)
        turned: Array = np.asarray(points) @ np.array([[c, s], [-s, c]])
        turned += (self.x, self.y)
        return turned
