"""Players whose control is elsewhere: bodies here, minds behind a wire."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ..control.walk_snapshots import StepStarted
from ..core.constants import GRAVITY
from ..core.poses import Array
from ..perception.measurement import Measurement
from ..sim.ground_truth import GroundTruth
from ..sim.push import Push
from ..sim.simulated_robot import SimulatedRobot
from .player import Snapshot, snapshot_of

if TYPE_CHECKING:
    from ..perception.frame_report import FrameReport

MOVED = 0.05  # of a target from the stance before a robot moves, in [rad]


class JointServer(Protocol):
    """What speaks for a robot whose joints are moved from elsewhere."""

    def act(self) -> None:
        """Let the robot do what was asked."""

    def close(self) -> None:
        """Stop speaking."""


class ServedBody:
    """A simulated robot as the server of its joints sees it.

    Until the game begins the world stands still: its sensors say the same
    all the time, which is what they say of a robot that stands at rest, and
    what is commanded does nothing.

    Attributes:
        is_moving: Whether its targets have left the stance.
    """

    def __init__(
        self, robot: SimulatedRobot, head: Sequence[int] = ()
    ) -> None:
        """Hold a robot that stands in its world.

        Args:
            robot: The robot.
            head: Numbers of the joints that turn its head: who looks about
                does not move.
        """
        self._robot, self._head = robot, list(head)
        self._held = True
        self._seen: Measurement | None = None
        self._ticks = -1
        self._stance: Array | None = None
        self.is_moving = False

    def let_go(self) -> None:
        """Let the game begin."""
        self._held = False

    def sensors(self) -> Measurement:
        """What its sensors give: read once a tick, as noise is drawn."""
        ticks = self._robot.world.ticks
        if self._seen is None or ticks != self._ticks:
            self._seen, self._ticks = self._robot.read(), ticks
        return self._at_rest(self._seen) if self._held else self._seen

    def _at_rest(self, seen: Measurement) -> Measurement:
        """Add gravity to what sensors give before the first step of physics.

        Until then no force acts, neither in the torso nor on the soles.
        """
        forces = np.full_like(
            seen.foot_forces, self._robot.weight / seen.foot_forces.size
        )
        return seen._replace(
            accelerometer=np.array([0.0, 0.0, GRAVITY]), foot_forces=forces
        )

    def command(self, targets: Array, stiffness: Array) -> None:
        """Set joint targets, in [rad], and shares of the torque."""
        if self._held:
            return
        if self._stance is None:
            self._stance = targets
        moved = np.abs(targets - self._stance)
        moved[self._head] = 0.0
        self.is_moving = self.is_moving or bool(moved.max() > MOVED)
        self._robot.servos.soften(stiffness)
        self._robot.write(targets)


class ServedPlayer:
    """A robot in the world whose control is in another process.

    Attributes:
        name: Who it is.
        server: What speaks for it.
        body: What the server moves.
        truth: Where it really is.
        begun: None: its plans are not known here.
        reports: None: what it sees is not known here.
    """

    begun: StepStarted | None = None
    reports: "Sequence[FrameReport]" = ()

    def __init__(
        self, robot: SimulatedRobot, body: ServedBody, server: JointServer
    ) -> None:
        """Join a robot and what speaks for it."""
        self.name = robot.name
        self.robot, self.body, self.server = robot, body, server
        self.truth: GroundTruth = robot.truth

    @property
    def is_moving(self) -> bool:
        """Whether it walks, rather than stands and waits."""
        return self.body.is_moving

    @property
    def has_fallen(self) -> bool:
        """Whether it lies."""
        return self.truth.has_fallen

    def tick(self) -> None:
        """Do what was asked for over the wire."""
        self.server.act()

    def snapshot(self) -> Snapshot:
        """State of this instant, as far as it is known here."""
        return snapshot_of(self.robot)

    def push(self, *pushes: Push) -> None:
        """Let somebody push the torso, now or later."""
        self.robot.push(*pushes)

    def close(self) -> None:
        """Let go of client and eyes."""
        self.server.close()
        self.robot.close()
