"""Whole-body reference for inverse kinematics."""

from collections.abc import Sequence
from math import cos, remainder, sin, tau
from typing import Any, NamedTuple

from ..core.compilation import inlined
from ..core.poses import Array


@inlined
def torso_roll(row: Sequence[float] | Array, lean: float) -> float:
    """Return the roll of a torso; see :meth:`BodyReference.roll`."""
    if lean == 0.0:
        return 0.0
    c, s = cos(row[6]) + cos(row[10]), sin(row[6]) + sin(row[10])
    x, y = row[0] - 0.5 * (row[3] + row[7]), row[1] - 0.5 * (row[4] + row[8])
    apart = c * (row[4] - row[8]) - s * (row[3] - row[7])
    return -2.0 * lean * (c * y - s * x) / apart


class BodyReference(NamedTuple):
    """Desired CoM and feet at one instant, all in one level frame."""

    com: tuple[float, float, float]  # CoM (x, y, z) [m]
    # left foot (x, y, z, yaw) [m] and [rad]
    left_foot: tuple[float, float, float, float]
    right_foot: tuple[float, float, float, float]  # right foot, likewise
    # roll and pitch of the left foot in the frame of its heading [rad]; small
    # angles
    left_tilt: tuple[float, float] = (0.0, 0.0)
    # roll and pitch of the right foot, likewise
    right_tilt: tuple[float, float] = (0.0, 0.0)

    def row(self) -> tuple[float, ...]:
        """Return the 15 numbers of the fields, one after the other."""
        com, left, right, left_tilt, right_tilt = self
        return (*com, *left, *right, *left_tilt, *right_tilt)

    @classmethod
    def from_row(cls, row: Sequence[float]) -> "BodyReference":
        """Return the reference of a row; see :meth:`row`."""
        own: Any = tuple(row)
        return cls(own[:3], own[3:7], own[7:11], own[11:13], own[13:])

    @property
    def heading(self) -> float:
        """Mean heading of the feet, in [rad]."""
        left, right = self.left_foot[3], self.right_foot[3]
        return left + 0.5 * remainder(right - left, tau)

    def roll(self, lean: float) -> float:
        """Return the roll [rad] of a torso that leans over the stance foot.

        It is proportional to the lateral position of the CoM: zero midway
        between the feet, ``lean`` with the CoM over one of them.
        """
        return torso_roll(self.row(), lean)
