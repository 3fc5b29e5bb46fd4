"""Whole-body reference for inverse kinematics."""

from collections.abc import Sequence
from math import cos, remainder, sin, tau
from typing import NamedTuple


class BodyReference(NamedTuple):
    """Desired CoM and feet at one instant, all in one level frame.

    Attributes:
        com: CoM (x, y, z), in [m].
        left_foot: Left foot (x, y, z, yaw), in [m] and [rad].
        right_foot: Right foot, likewise.
        left_tilt: Roll and pitch of the left foot in the frame of its
            heading, in [rad]; small angles.
        right_tilt: Roll and pitch of the right foot, likewise.
    """

    com: tuple[float, float, float]
    left_foot: tuple[float, float, float, float]
    right_foot: tuple[float, float, float, float]
    left_tilt: tuple[float, float] = (0.0, 0.0)
    right_tilt: tuple[float, float] = (0.0, 0.0)

    def row(self) -> tuple[float, ...]:
        """Return the 15 numbers of the fields, one after the other."""
        com, left, right, left_tilt, right_tilt = self
        return (*com, *left, *right, *left_tilt, *right_tilt)

    @classmethod
    def from_row(cls, row: Sequence[float]) -> "BodyReference":
        """Return the reference of a row; see :meth:`row`."""
        x, y, z, a, b, c, d, e, f, g, h, *tilts = row
        return cls(
            (x, y, z),
            (a, b, c, d),
            (e, f, g, h),
            (tilts[0], tilts[1]),
            (tilts[2], tilts[3]),
        )

    @property
    def heading(self) -> float:
        """Mean heading of the feet, in [rad]."""
        left, right = self.left_foot[3], self.right_foot[3]
        return left + 0.5 * remainder(right - left, tau)

    def roll(self, lean: float) -> float:
        """Return the roll of a torso that leans over the stance foot.

        The roll is proportional to the lateral position of the CoM: zero
        midway between the feet, ``lean`` with the CoM over one of them.

        Args:
            lean: Roll with the CoM over one foot, in [rad].

        Returns:
            Roll, in [rad].
        """
        if lean == 0.0:
            return 0.0
        (x, y, _), (u, v, *_), (p, q, *_) = self[:3]
        c, s = cos(self.heading), sin(self.heading)
        aside = c * (y - 0.5 * (v + q)) - s * (x - 0.5 * (u + p))
        apart = c * (v - q) - s * (u - p)
        return -2.0 * lean * aside / apart
