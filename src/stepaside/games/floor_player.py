"""Players that physics does not move: people, unicycles, recorded motions.

A body on the floor shows the player and gives its true state. Its motion is
that of a game without bodies (:mod:`.floor_world`).
"""

from collections.abc import Callable
from typing import Protocol

from ..core.poses import Pose
from ..sim.ground_truth import FloorTruth
from ..sim.person_body import pose_template
from ..sim.world import World
from .floor_world import AT_ONCE, FloorMotion, Seen
from .player import Player, Snapshot

MARKER_HEIGHT = 0.27  # that stands for the CoM of a marker, in [m]
MARKER_REACH = 0.1  # of a marker, which touches nothing, in [m]


class FloorBody(Protocol):
    """Body on the floor.

    Attributes:
        name: Name of the player.
        world: The world.
        truth: True state.
    """

    name: str
    world: World
    truth: FloorTruth

    def move(self, pose: Pose) -> None:
        """Move to a pose in the world."""


class MarkerBody:
    """Marker of a unicycle or of a recorded player, without contacts.

    Attributes:
        name: Name of the player.
        world: The world.
        truth: True state.
    """

    def __init__(self, world: World, name: str, pose: Pose) -> None:
        """Set the marker to a pose."""
        self.name, self.world = name, world
        self.truth = FloorTruth(pose, reach=MARKER_REACH, height=MARKER_HEIGHT)
        self.move(pose)

    def move(self, pose: Pose) -> None:
        """Move to a pose in the world."""
        self.truth.pose = pose
        pose_template(self.world.model, self.world.data, self.name, pose)


class FloorPlayer(Player):
    """Player that physics does not move.

    Attributes:
        motion: Its motion.
    """

    def __init__(
        self, body: FloorBody, motion: FloorMotion, seen: Callable[[], Seen]
    ) -> None:
        """Combine a body, its motion, and what it sees of all players."""
        self.name, self._body, self.motion = body.name, body, motion
        self.truth, self._seen = body.truth, seen

    def tick(self) -> None:
        """Advance the motion by one tick."""
        world, motion = self._body.world, self.motion
        until = world.time + world.physics.tick
        while motion.due < until - AT_ONCE:
            motion.advance(motion.due)
            motion.decide(motion.due, self._seen())
        motion.advance(until)
        self._body.move(motion.pose)

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        x, y, z = self.truth.position_com_in_world.tolist()
        pose = self._body.truth.pose
        time = self._body.world.time
        return Snapshot(self.name, time, pose, pose, (x, y, z))
