"""What only the simulator knows of a robot."""

from math import atan2, cos, hypot, radians

import mujoco

from ..poses import Array

FALLEN = cos(radians(45.0))  # upward component of the torso's axis


class TrueState:
    """True state of one robot in its world.

    Attributes:
        com: CoM of the robot, in [m], as a view. Shape (3,).
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, torso: str
    ) -> None:
        """Watch the robot whose torso has a given name."""
        root = model.body(torso).id
        self._position: Array = data.xpos[root]
        self._frame: Array = data.xmat[root]
        self.com: Array = data.subtree_com[root]

    @property
    def position(self) -> tuple[float, float]:
        """Place of the torso in the world, in [m]."""
        x, y, _ = self._position.tolist()
        return x, y

    @property
    def heading(self) -> float:
        """Heading of the torso in the world, in [rad]."""
        return atan2(self._frame[3], self._frame[0])

    @property
    def has_fallen(self) -> bool:
        """Whether the torso leans by more than 45 degrees."""
        return bool(self._frame[8] < FALLEN)

    def distance_to(self, other: "TrueState") -> float:
        """Horizontal distance between the torsos, in [m]."""
        x, y = self.position
        u, v = other.position
        return hypot(u - x, v - y)
