"""Players whose joints another process commands."""

from collections.abc import Sequence

import numpy as np

from ..core.constants import GRAVITY
from ..core.poses import Array
from ..perception.measurement import RobotState
from ..sim.simulated_robot import SimulatedRobot
from .player import PhysicalPlayer

MOVING = 0.05  # change of a target from which a robot moves, in [rad]


class ServedPlayer(PhysicalPlayer):
    """Simulated robot whose joints another process commands.

    Until the game begins the simulation does not advance: the sensors
    constantly report a robot at rest, and commands are ignored.

    Its plans and detections are unknown to this process. Its server waits
    for the client before the match.
    """

    def __init__(
        self, robot: SimulatedRobot, head: Sequence[int] = ()
    ) -> None:
        """Take a robot that stands in its world."""
        super().__init__(robot)
        self._moves = False
        self._head = list(head)
        self._waiting = True
        self._stance: Array | None = None

    @property
    def is_moving(self) -> bool:
        """Whether its targets have left the initial stance."""
        return self._moves

    def begin(self) -> None:
        """Begin the game: apply commands from now on."""
        self._waiting = False

    def sensors(self) -> RobotState:
        """Return the measurement of this tick, as the client gets it."""
        measured = self.measure()
        return self._at_rest(measured) if self._waiting else measured

    def _at_rest(self, measurement: RobotState) -> RobotState:
        """Add gravity and foot forces of a robot that stands.

        Before the first step of physics the simulation has no forces.
        """
        forces = np.full_like(
            measurement.foot_forces,
            self.robot.weight / measurement.foot_forces.size,
        )
        return measurement._replace(
            accelerometer=np.array([0.0, 0.0, GRAVITY]), foot_forces=forces
        )

    def command(self, targets: Array, stiffness: Array) -> None:
        """Set joint targets, in [rad], and stiffness from 0 to 1."""
        if self._waiting:
            return
        if self._stance is None:
            self._stance = targets
        change = np.abs(targets - self._stance)
        change[self._head] = 0.0
        self._moves = self._moves or bool(change.max() > MOVING)
        self.robot.servos.soften(stiffness)
        self.robot.write(targets)

    def tick(self) -> None:
        """Do nothing: the server has applied the last command."""
