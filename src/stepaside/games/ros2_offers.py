"""Robots of our world on ROS 2 topics."""

from ..drivers.lola.nao_joints import TICK
from ..drivers.ros2.dds_domain import DdsParticipant
from ..drivers.ros2.ros2_server import Ros2Server, WorldClock
from .robot_offers import OfferedPlayer
from .velocity_walker import VelocityWalker
from .walker import Walker


class Ros2Offer:
    """A robot that walks by itself, at velocities from a topic."""

    def __init__(
        self,
        dds: DdsParticipant,
        clock: WorldClock,
        namespace: str,
        *,
        ideal_sight: bool = True,
    ) -> None:
        """Offer a robot in a namespace.

        Args:
            dds: Where.
            clock: Tells the time of the world there.
            namespace: With a slash before it, or empty.
            ideal_sight: Whether the true line of sight is told.
        """
        self._dds, self._clock = dds, clock
        self._namespace, self._ideal_sight = namespace, ideal_sight

    def serve(self, walker: Walker, *, lock_step: bool) -> OfferedPlayer:
        """Offer a robot that keeps itself up."""
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
