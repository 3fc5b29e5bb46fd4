"""Simulated robots offered over NAOqi, by velocity or by joints."""

from typing import NamedTuple

from ..control.velocity_walk import velocity_limits
from ..core.errors import ConfigurationError
from ..drivers.lola.nao_joints import TICK
from ..drivers.naoqi.joint_server import NaoqiJointServer
from ..drivers.naoqi.naoqi_server import NaoqiServer
from ..drivers.velocity.velocity_body import VelocityCommand
from .robot_offers import OfferedPlayer
from .served_player import ServedBody, ServedPlayer
from .velocity_walker import VelocityWalker
from .walker import SimulatedPlayer


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
        body = ServedBody(walker.robot)
        server = NaoqiJointServer(
            self.url,
            body,
            walker.scheme.kinematics.joint_names,
            lock_step=lock_step,
            ideal_sight=self.ideal_sight,
        )
        return OfferedPlayer(ServedPlayer(walker.robot, body, server), server)
