"""A player that is a robot in the world, with its own control."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..control import ControlScheme, Phase
from ..control.sight_sources import CameraSight
from ..control.walk_snapshots import StepStarted
from ..core.poses import Pose
from ..sim.ground_truth import GroundTruth
from ..sim.push import Push
from ..sim.simulated_robot import SimulatedRobot
from .player import Snapshot, snapshot_of

if TYPE_CHECKING:
    from ..perception.frame_report import FrameReport


class Walker:
    """A body and the mind that moves it.

    Attributes:
        name: Who it is.
        robot: Its body.
        scheme: Its control.
        frame: Pose of its odometry in the world.
        truth: Where it really is.
    """

    def __init__(
        self, robot: SimulatedRobot, scheme: ControlScheme, frame: Pose
    ) -> None:
        """Join body and mind."""
        self.name = robot.name
        self.robot, self.scheme, self.frame = robot, scheme, frame
        self.truth: GroundTruth = robot.truth

    @property
    def begun(self) -> StepStarted | None:
        """Step that it began at the last tick, if it did."""
        return self.scheme.begun

    @property
    def reports(self) -> "Sequence[FrameReport]":
        """What the images that reached it at the last tick show."""
        senses = self.scheme.senses
        if isinstance(senses, CameraSight):
            return senses.perception.reports
        return ()

    @property
    def is_moving(self) -> bool:
        """Whether it walks, rather than stands and waits."""
        return self.scheme.phase is not Phase.STANDING

    @property
    def has_fallen(self) -> bool:
        """Whether it lies, or feels that it falls."""
        return self.truth.has_fallen or self.scheme.phase is Phase.FALLEN

    def tick(self) -> None:
        """Read the sensors, decide, and send joint targets."""
        robot = self.robot
        robot.write(self.scheme.update(robot.read()))

    def snapshot(self) -> Snapshot:
        """State of this instant."""
        walk = self.scheme.state
        return snapshot_of(self.robot, frame=self.frame, walk=walk)

    def push(self, *pushes: Push) -> None:
        """Let somebody push the torso, now or later."""
        self.robot.push(*pushes)

    def close(self) -> None:
        """Let go of the eyes."""
        self.robot.close()
