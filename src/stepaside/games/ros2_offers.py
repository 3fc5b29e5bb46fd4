"""Simulated robots offered on ROS 2 topics."""

from ..drivers.lola.nao_joints import TICK
from ..drivers.ros2.dds_domain import DdsParticipant
from ..drivers.ros2.ros2_server import Ros2Server, WorldClock
from .robot_offers import OfferedPlayer
from .velocity_walker import VelocityWalker
from .walker import SimulatedPlayer


class Ros2Offer:
    """Robot with its own walk, commanded by velocities from a topic."""

    def __init__(
        self,
        dds: DdsParticipant,
        clock: WorldClock,
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
