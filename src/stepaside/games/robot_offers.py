"""How a robot of our world is offered to control that is elsewhere."""

from typing import NamedTuple, Protocol

from ..control.sight_sources import CameraSight
from ..drivers.lola.lola_address import LolaAddress
from ..drivers.lola.lola_server import LolaServer
from .lockstep import RobotServer
from .player import Player
from .served_player import ServedBody, ServedPlayer
from .walker import Walker


class OfferedPlayer(NamedTuple):
    """A player whose control is elsewhere, and what speaks for it."""

    player: Player
    server: RobotServer


class Offer(Protocol):
    """A language, and the place where it is spoken."""

    def serve(self, walker: Walker, *, lock_step: bool) -> OfferedPlayer:
        """Offer a robot.

        Args:
            walker: The robot; it is not to be used any more.
            lock_step: Whether the world waits for answers.

        Raises:
            StepAsideError: If it cannot be offered there.
        """


class LolaOffer(NamedTuple):
    """Joints over LoLA.

    Attributes:
        address: Where the robot listens.
        ideal_sight: Whether the true line of sight is offered beside.

    What the cameras of a robot that has some see is always offered.
    """

    address: LolaAddress
    ideal_sight: bool = True

    def serve(self, walker: Walker, *, lock_step: bool) -> OfferedPlayer:
        """Offer a robot's joints; who plays it has to keep it up."""
        senses = walker.scheme.senses
        head: tuple[int, ...] = ()
        if isinstance(senses, CameraSight):
            head = senses.perception.head_joints
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
