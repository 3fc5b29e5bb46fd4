"""What the body is asked to do at one instant."""

from math import cos, remainder, sin, tau
from typing import NamedTuple


class BodyReference(NamedTuple):
    """What the body is asked to do at one instant, in one level frame.

    Attributes:
        com: CoM (x, y, z), in [m].
        left_foot: Left foot (x, y, z, yaw), in [m] and [rad].
        right_foot: Right foot, likewise.
        left_tilt: Roll and pitch of the left foot about its own heading, in
            [rad], small.
        right_tilt: Those of the right foot.
    """

    com: tuple[float, float, float]
    left_foot: tuple[float, float, float, float]
    right_foot: tuple[float, float, float, float]
    left_tilt: tuple[float, float] = (0.0, 0.0)
    right_tilt: tuple[float, float] = (0.0, 0.0)

    @property
    def heading(self) -> float:
        """Heading between those of the feet, in [rad]."""
        left, right = self.left_foot[3], self.right_foot[3]
        return left + 0.5 * remainder(right - left, tau)

    def roll(self, lean: float) -> float:
        """Roll of a torso that leans over the foot that stands, in [rad].

        It goes with the CoM: level midway between the feet, and leaning
        where the CoM is right over one of them.

        Args:
            lean: How far it leans there, in [rad].
        """
        if lean == 0.0:
            return 0.0
        (x, y, _), (u, v, *_), (p, q, *_) = self[:3]
        c, s = cos(self.heading), sin(self.heading)
        aside = c * (y - 0.5 * (v + q)) - s * (x - 0.5 * (u + p))
        apart = c * (v - q) - s * (u - p)
        return -2.0 * lean * aside / apart


class Posture(NamedTuple):
    """A posture by what joint motion moves.

    Attributes:
        place: Origin of the torso in the frame of the reference, in [m].
        heading: Heading of the torso, in [rad].
        free: Angles of the legs' free joints, in [rad].
        roll: Of the torso, in [rad].
    """

    place: tuple[float, float, float]
    heading: float
    free: tuple[float, ...]
    roll: float = 0.0
