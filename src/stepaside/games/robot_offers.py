"""Simulated robots offered to other processes for control."""

from typing import NamedTuple, Protocol

from ..control.sight_sources import CameraSight
from ..drivers.lola.lola_address import LolaAddress
from ..drivers.lola.lola_server import LolaServer
from .lockstep import RobotServer
from .player import Player
from .served_player import ServedBody, ServedPlayer
from .walker import SimulatedPlayer


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
