"""What only the simulator knows of a robot."""

from math import atan2, cos, hypot, radians, sin

import mujoco

from ..poses import Array

FALLEN = cos(radians(45.0))  # upward component of the torso's axis


class TrueState:
    """True state of one robot in its world.

    Its place stands for it in the game: midway between the feet of one that
    stands, and moving on with the CoM of one that walks. The origin of the
    torso is elsewhere, for it is wherever the CoM of the posture wants it.

    Attributes:
        com: CoM of the robot, in [m], as a view. Shape (3,).
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        torso: str,
        *,
        com_forward: float = 0.0,
    ) -> None:
        """Watch a robot.

        Args:
            model: Compiled model.
            data: Its state.
            torso: Body with its torso.
            com_forward: How far its gait keeps the CoM ahead of the place,
                in [m].
        """
        self._com_forward = com_forward
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

    def distance_to(self, other: "TrueState") -> float:
        """Horizontal distance between the torsos, in [m]."""
        x, y = self.position
        u, v = other.position
        return hypot(u - x, v - y)
