"""Protocols and addresses at which simulated robots are served."""

from typing import TYPE_CHECKING, NamedTuple, Protocol

from .client_synchroniser import RobotServer
from .physics_world import RemoteControl
from .player import Player
from .served_player import ServedPlayer
from .velocity_walker import VelocityWalker

if TYPE_CHECKING:
    from ..drivers.ros2_dds import DdsParticipant
    from ..drivers.ros2_server import WorldClock


class RobotEndpoint(Protocol):
    """Protocol and address at which a robot is served."""

    @property
    def control(self) -> RemoteControl:
        """How the client controls the robot."""

    def serve(self, player: Player, *, lock_step: bool) -> RobotServer:
        """Serve a robot.

        Args:
            player: Player placed with :attr:`control`.
            lock_step: Whether the simulation waits for commands.

        Raises:
            StepAsideError: If the robot cannot be served there.
        """


class LolaEndpoint(NamedTuple):
    """Joints served over LoLA.

    Attributes:
        path: Path of the socket.
        ideal_sight: Whether the true line of sight is served as well.
    """

    path: str
    ideal_sight: bool = True

    @property
    def control(self) -> RemoteControl:
        """Joint targets: the client balances the robot."""
        return RemoteControl(balances=False, ideal_sight=self.ideal_sight)

    def serve(self, player: Player, *, lock_step: bool) -> RobotServer:
        """Serve the joints of a robot; the client has to balance it."""
        from ..drivers.lola_server import LolaServer

        assert isinstance(player, ServedPlayer)
        return LolaServer(
            self.path,
            player,
            player.robot.joint_names,
            lock_step=lock_step,
            ideal_sight=self.ideal_sight,
        )


class Ros2Endpoint(NamedTuple):
    """Robot with its own walk, commanded by velocities from a topic.

    Attributes:
        dds: DDS participant of the simulation.
        clock: Publisher of the simulated time.
        namespace: Namespace with a leading slash, or empty.
        ideal_sight: Whether the true line of sight is published.
    """

    dds: "DdsParticipant"
    clock: "WorldClock"
    namespace: str
    ideal_sight: bool = True

    @property
    def control(self) -> RemoteControl:
        """Velocities: the robot balances itself."""
        return RemoteControl(balances=True, ideal_sight=self.ideal_sight)

    def serve(self, player: Player, *, lock_step: bool) -> RobotServer:
        """Serve a robot that balances itself."""
        from ..drivers.ros2_server import Ros2Server
        from ..robots.urdf_writer import urdf_of

        assert isinstance(player, VelocityWalker)
        return Ros2Server(
            self.dds,
            self.namespace,
            player,
            player.robot.joint_names,
            self.clock,
            tick=player.robot.world.physics.tick,
            lock_step=lock_step,
            urdf=urdf_of(player.description),
        )
