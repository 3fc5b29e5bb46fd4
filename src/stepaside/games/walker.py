"""Players that are simulated robots with their own control."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..control.scheme import ControlScheme
from ..control.sight_sources import CameraSight
from ..core.poses import Pose
from ..locomotion.locomotion import Phase, StepStarted
from ..sim.simulated_robot import SimulatedRobot
from .player import PhysicalPlayer, Snapshot, snapshot_of
from .walker_log import WalkerLog

if TYPE_CHECKING:
    from ..perception.pipeline import FrameReport, Perception


class RobotPlayer(PhysicalPlayer):
    """Simulated robot with its controller.

    Attributes:
        scheme: Controller.
        frame: Pose of its odometry in the world.
    """

    def __init__(
        self, robot: SimulatedRobot, scheme: ControlScheme, frame: Pose
    ) -> None:
        """Combine a robot and its controller."""
        super().__init__(robot)
        self.scheme, self.frame = scheme, frame

    @property
    def begun(self) -> StepStarted | None:
        """Step begun at the last tick, if any."""
        return self.scheme.begun

    @property
    def _perception(self) -> "Perception | None":
        senses = self.scheme.senses
        return senses.perception if isinstance(senses, CameraSight) else None

    @property
    def reports(self) -> "Sequence[FrameReport]":
        """Detections of the images that arrived at the last tick."""
        perception = self._perception
        return () if perception is None else perception.reports

    @property
    def is_ready(self) -> bool:
        """Whether it has scanned the room, if it maps it."""
        perception = self._perception
        return perception is None or perception.head.is_ready

    def start(self) -> None:
        """Receive the signal that the game begins."""
        if self._perception is not None:
            self._perception.head.start()

    @property
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return self.scheme.phase is not Phase.STANDING

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen, or has detected a fall."""
        return self.truth.has_fallen or self.scheme.phase is Phase.FALLEN

    def tick(self) -> None:
        """Read the sensors, decide, and send joint targets."""
        self.robot.write(self.scheme.update(self.robot.read()))

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        walk = self.scheme.locomotion.maneuvers
        return snapshot_of(self.robot, frame=self.frame, walk=walk)


class SimulatedPlayer(RobotPlayer):
    """Simulated robot that walks by maneuvers."""

    def __init__(
        self, robot: SimulatedRobot, scheme: ControlScheme, frame: Pose
    ) -> None:
        """Combine a robot and its controller."""
        super().__init__(robot, scheme, frame)
        # Exact sightings are read when a decision is due.
        self._coasts = robot.sees_exactly
        self._feels = scheme.feels or not self._coasts

    def tick(self) -> None:
        """Read the sensors, decide, and send joint targets."""
        robot, scheme = self.robot, self.scheme
        now, targets = robot.world.time, None
        if self._coasts:
            targets = scheme.coast(now)
        if targets is None:
            sees = not self._coasts or scheme.decides(now)
            targets = scheme.update(robot.read(sees=sees, feels=self._feels))
        robot.write(targets)

    def motion_log(self, *, closely: bool) -> WalkerLog:
        """Return an empty log of its motion."""
        return WalkerLog(
            self.robot, self.scheme.walk, self.frame, closely=closely
        )
