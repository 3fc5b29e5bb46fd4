"""Players whose joints another process commands."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.constants import GRAVITY
from ..core.poses import Array
from ..locomotion.walk_snapshots import StepStarted
from ..perception.measurement import Measurement
from ..sim.ground_truth import GroundTruth
from ..sim.push import Push
from ..sim.robot_state_log import RobotStateLog
from ..sim.simulated_robot import SimulatedRobot
from .player import Snapshot, snapshot_of

if TYPE_CHECKING:
    from ..perception.percept_stages import FrameReport

MOVING = 0.05  # change of a target from which a robot moves, in [rad]


class ServedPlayer:
    """Simulated robot whose joints another process commands.

    Until the game begins the simulation does not advance: the sensors
    constantly report a robot at rest, and commands are ignored.

    Attributes:
        name: Name of the player.
        robot: Simulated robot.
        truth: True state.
        is_moving: Whether its targets have left the initial stance.
        is_ready: True: its server waits for the client before the match.
        begun: None: its plans are unknown to this process.
        reports: Empty: its detections are unknown to this process.
    """

    is_ready = True
    begun: StepStarted | None = None
    reports: "Sequence[FrameReport]" = ()

    def __init__(
        self, robot: SimulatedRobot, head: Sequence[int] = ()
    ) -> None:
        """Take a robot that stands in its world.

        Args:
            robot: The robot.
            head: Indices of the head joints, whose motion does not count as
                moving.
        """
        self.name, self.robot = robot.name, robot
        self.truth: GroundTruth = robot.truth
        self.is_moving = False
        self._head = list(head)
        self._waiting = True
        self._measurement: Measurement | None = None
        self._ticks = -1
        self._stance: Array | None = None

    def begin(self) -> None:
        """Begin the game: apply commands from now on."""
        self._waiting = False

    def sensors(self) -> Measurement:
        """Return the measurement of this tick; noise is drawn once."""
        ticks = self.robot.world.ticks
        if self._measurement is None or ticks != self._ticks:
            self._measurement, self._ticks = self.robot.read(), ticks
        if self._waiting:
            return self._at_rest(self._measurement)
        return self._measurement

    def _at_rest(self, measurement: Measurement) -> Measurement:
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
        self.is_moving = self.is_moving or bool(change.max() > MOVING)
        self.robot.servos.soften(stiffness)
        self.robot.write(targets)

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen."""
        return self.truth.has_fallen

    def start(self) -> None:
        """Do nothing: its client begins with the released chest button."""

    def tick(self) -> None:
        """Do nothing: the server has applied the last command."""

    def snapshot(self) -> Snapshot:
        """Return the state at this instant, without plans."""
        return snapshot_of(self.robot)

    def motion_log(self, *, closely: bool) -> RobotStateLog:
        """Return an empty log of its motion; estimates are unknown."""
        return self.robot.state_log()

    def push(self, *pushes: Push) -> None:
        """Schedule pushes of the torso, now or later."""
        self.robot.push(*pushes)

    def close(self) -> None:
        """Close the cameras."""
        self.robot.close()
