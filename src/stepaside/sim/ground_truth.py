"""What only the simulator knows of a robot."""

from math import atan2, cos, hypot, radians, sin
from typing import Protocol

import mujoco

from ..core.poses import Array
from ..robots.description_types import ReferencePoint

FALLEN = cos(radians(45.0))  # upward component of the torso's axis


class GroundTruth(Protocol):
    """Where a player really is, whatever it is."""

    @property
    def reach(self) -> float:
        """Distance from the torso within which all of it lies, in [m]."""

    @property
    def com(self) -> Array:
        """CoM, or what stands for it, in [m]. Shape (3,)."""

    @property
    def position(self) -> tuple[float, float]:
        """Place of the torso in the world, in [m]."""

    @property
    def place(self) -> tuple[float, float]:
        """Point that stands for the player in the game, in [m]."""

    @property
    def heading(self) -> float:
        """Where it heads in the world, in [rad]."""

    @property
    def has_fallen(self) -> bool:
        """Whether it lies."""


def torsos_apart(one: GroundTruth, other: GroundTruth) -> float:
    """Horizontal distance between two torsos, in [m]."""
    (x, y), (u, v) = one.position, other.position
    return hypot(u - x, v - y)


class TrueRobotState:
    """True state of one robot in its world.

    Its place stands for it in the game: midway between the feet of one that
    stands, and moving on with the CoM of one that walks. The origin of the
    torso is elsewhere, for it is wherever the CoM of the posture wants it.

    Attributes:
        com: CoM of the robot, in [m], as a view. Shape (3,).
        reach: Distance from its torso within which all of it lies, in [m].
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        torso: str,
        *,
        com_forward: float = 0.0,
        place: ReferencePoint | None = None,
    ) -> None:
        """Watch a robot.

        Args:
            model: Compiled model.
            data: Its state.
            torso: Body with its torso.
            com_forward: How far its gait keeps the CoM ahead of the place,
                in [m].
            place: Where the hips are in the torso's frame, and how far the
                robot reaches.
        """
        self._com_forward = com_forward
        place = place or ReferencePoint()
        self._forward, self.reach = place.forward, place.reach
        root = model.body(torso).id
        self._position: Array = data.xpos[root]
        self._frame: Array = data.xmat[root]
        self.com: Array = data.subtree_com[root]

    @property
    def position(self) -> tuple[float, float]:
        """Point of the torso midway between the hips, in the world [m]."""
        x, y, _ = self._position.tolist()
        ahead = self._forward
        if ahead == 0.0:
            return x, y
        axis = self._frame
        return x + ahead * float(axis[0]), y + ahead * float(axis[3])

    @property
    def place(self) -> tuple[float, float]:
        """Point that stands for the robot in the world, in [m]."""
        x, y, _ = self.com.tolist()
        ahead, heading = self._com_forward, self.heading
        return x - ahead * cos(heading), y - ahead * sin(heading)

    @property
    def heading(self) -> float:
        """Heading of the torso in the world, in [rad]."""
        return atan2(self._frame[3], self._frame[0])

    @property
    def has_fallen(self) -> bool:
        """Whether the torso leans by more than 45 degrees."""
        return bool(self._frame[8] < FALLEN)
