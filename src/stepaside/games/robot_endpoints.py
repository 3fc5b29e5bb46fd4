"""Simulated robots offered to other processes for control."""

from typing import TYPE_CHECKING, NamedTuple, Protocol

from ..control.sight_sources import CameraSight
from ..control.velocity_walk import velocity_limits
from ..core.errors import ConfigurationError
from ..drivers.lola.lola_address import LolaAddress
from ..drivers.lola.lola_server import LolaServer
from ..drivers.lola.nao_joints import TICK
from ..drivers.velocity.velocity_body import VelocityCommand
from .client_synchroniser import RobotServer
from .player import Player
from .served_player import ServedBody, ServedPlayer
from .velocity_walker import VelocityWalker
from .walker import SimulatedPlayer

if TYPE_CHECKING:
    from ..drivers.ros2.dds_domain import DdsParticipant
    from ..drivers.ros2.ros2_server import WorldClock


class OfferedPlayer(NamedTuple):
    """Player that another process controls, with its server."""

    player: Player
    server: RobotServer


class Offer(Protocol):
    """Protocol and address at which a robot is served."""

    def serve(
        self, walker: SimulatedPlayer, *, lock_step: bool
    ) -> OfferedPlayer:
        """Serve a robot.

        Args:
            walker: The robot; it must not be used afterwards.
            lock_step: Whether the simulation waits for commands.

        Raises:
            StepAsideError: If the robot cannot be served there.
        """


class LolaOffer(NamedTuple):
    """Joints served over LoLA, with the images of a robot with cameras.

    Attributes:
        address: Address of the server.
        ideal_sight: Whether the true line of sight is served as well.
    """

    address: LolaAddress
    ideal_sight: bool = True

    def serve(
        self, walker: SimulatedPlayer, *, lock_step: bool
    ) -> OfferedPlayer:
        """Serve the joints of a robot; the client has to balance it."""
        senses = walker.scheme.senses
        head: tuple[int, ...] = ()
        if isinstance(senses, CameraSight):
            kinematics = senses.perception.poses.kinematics
            head = kinematics.yaw, kinematics.pitch
        body = ServedBody(walker.robot, head)
        server = LolaServer(
            self.address,
            body,
            walker.scheme.kinematics.joint_names,
            lock_step=lock_step,
            ideal_sight=self.ideal_sight,
            cameras=walker.robot.eyes is not None,
        )
        return OfferedPlayer(ServedPlayer(walker.robot, body, server), server)


class NaoqiOffer(NamedTuple):
    """Robot with its own walk, commanded by velocities.

    Attributes:
        url: URL of its services, like tcp://127.0.0.1:PORT.
        ideal_sight: Whether the true line of sight is served.
    """

    url: str
    ideal_sight: bool = True

    def serve(
        self, walker: SimulatedPlayer, *, lock_step: bool
    ) -> OfferedPlayer:
        """Serve a robot that balances itself."""
        from ..drivers.naoqi.naoqi_server import NaoqiServer

        if lock_step:
            raise ConfigurationError(
                "a robot on NAOqi cannot be served in lock step: its calls "
                "carry no time"
            )
        player = VelocityWalker(walker, offers_sight=self.ideal_sight)
        server = NaoqiServer(
            self.url,
            player,
            walker.scheme.kinematics.joint_names,
            VelocityCommand(*velocity_limits(walker.scheme.gait)),
            tick=TICK,
            gait=walker.scheme.gait,
        )
        player.commander = server
        return OfferedPlayer(player, server)


class NaoqiJointsOffer(NamedTuple):
    """Robot whose joints are set by calls; the client balances it.

    Attributes:
        url: URL of its services, like tcp://127.0.0.1:PORT.
        ideal_sight: Whether the true line of sight is served.
    """

    url: str
    ideal_sight: bool = True

    def serve(
        self, walker: SimulatedPlayer, *, lock_step: bool
    ) -> OfferedPlayer:
        """Serve the joints of a robot."""
        from ..drivers.naoqi.joint_server import NaoqiJointServer

        body = ServedBody(walker.robot)
        server = NaoqiJointServer(
            self.url,
            body,
            walker.scheme.kinematics.joint_names,
            lock_step=lock_step,
            ideal_sight=self.ideal_sight,
        )
        return OfferedPlayer(ServedPlayer(walker.robot, body, server), server)


class Ros2Offer:
    """Robot with its own walk, commanded by velocities from a topic."""

    def __init__(
        self,
        dds: "DdsParticipant",
        clock: "WorldClock",
        namespace: str,
        *,
        ideal_sight: bool = True,
    ) -> None:
        """Choose the namespace of a robot.

        Args:
            dds: DDS participant of the simulation.
            clock: Publisher of the simulated time.
            namespace: Namespace with a leading slash, or empty.
            ideal_sight: Whether the true line of sight is published.
        """
        self._dds, self._clock = dds, clock
        self._namespace, self._ideal_sight = namespace, ideal_sight

    def serve(
        self, walker: SimulatedPlayer, *, lock_step: bool
    ) -> OfferedPlayer:
        """Serve a robot that balances itself."""
        from ..drivers.ros2.ros2_server import Ros2Server

        player = VelocityWalker(walker, offers_sight=self._ideal_sight)
        server = Ros2Server(
            self._dds,
            self._namespace,
            player,
            walker.scheme.kinematics.joint_names,
            self._clock,
            tick=TICK,
            lock_step=lock_step,
        )
        player.commander = server
        return OfferedPlayer(player, server)
