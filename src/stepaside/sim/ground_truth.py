"""True state of players, known to the simulator only."""

from math import atan2, cos, hypot, radians, sin
from typing import Protocol

import mujoco

from ..core.poses import Array
from ..robots.description_types import ReferencePoint

FALLEN = cos(radians(45.0))  # upward component of the torso's axis


class GroundTruth(Protocol):
    """True state of a player: a robot, a person or a template."""

    @property
    def reach(self) -> float:
        """Radius around the torso that contains the whole body, in [m]."""

    @property
    def com(self) -> Array:
        """CoM, or an equivalent point, in the world, in [m]. Shape (3,)."""

    @property
    def position(self) -> tuple[float, float]:
        """Position of the torso in the world, in [m]."""

    @property
    def place(self) -> tuple[float, float]:
        """Reference point of the player in the world, in [m]."""

    @property
    def heading(self) -> float:
        """Heading in the world, in [rad]."""

    @property
    def has_fallen(self) -> bool:
        """Whether the player has fallen."""


def torsos_apart(one: GroundTruth, other: GroundTruth) -> float:
    """Return the horizontal distance between two torsos, in [m]."""
    (x, y), (u, v) = one.position, other.position
    return hypot(u - x, v - y)


class TrueRobotState:
    """True state of one robot in its world.

    The reference point is midway between the feet of a standing robot, and
    moves with the CoM of a walking one. The origin of the torso is elsewhere:
    its position follows from the posture with the CoM over the feet.

    Attributes:
        com: CoM of the robot in the world, in [m], as a view. Shape (3,).
        reach: Radius around the torso that contains the whole robot, in [m].
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
        """Read the state of a robot.

        Args:
            model: Compiled model.
            data: Its state.
            torso: Name of its torso body.
            com_forward: Offset of the CoM ahead of the reference point in
                its gait, in [m].
            place: Position of the hips in the torso frame, and reach of the
                robot.
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
        """Point midway between the hips in the world, in [m]."""
        x, y, _ = self._position.tolist()
        ahead = self._forward
        if ahead == 0.0:
            return x, y
        axis = self._frame
        return x + ahead * float(axis[0]), y + ahead * float(axis[3])

    @property
    def place(self) -> tuple[float, float]:
        """Reference point in the world, in [m]."""
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
