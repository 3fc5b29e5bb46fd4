"""Players of a game in physics, and those that physics does not move.

A body on the floor shows the player and gives its true state. Its motion is
that of a game without bodies (:mod:`.floor_world`).
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..locomotion.locomotion import StepStarted
from ..locomotion.maneuver_walk import ManeuverWalk
from ..sim.ground_truth import FloorTruth, GroundTruth
from ..sim.person_body import PersonBody, pose_template
from ..sim.push import Push, ScheduledPush
from ..sim.world import World
from .floor_world import AT_ONCE, FloorMotion, Seen

if TYPE_CHECKING:
    from ..perception.pipeline import FrameReport

MARKER_HEIGHT = 0.27  # that stands for the CoM of a marker, in [m]
MARKER_REACH = 0.1  # of a marker, which touches nothing, in [m]


class Player:
    """Player of a game in physics: a robot, a person or a moved marker.

    Attributes:
        truth: True state, for the rules of the game and the record.
        frame: Pose of its odometry in the world; None if that is unknown.
    """

    name: str
    truth: GroundTruth
    frame: Pose | None = None

    @property
    def place_in_world(self) -> Pose:
        """Reference point and heading."""
        truth = self.truth
        return Pose(*truth.position_reference_in_world, truth.heading_in_world)

    @property
    def torso_in_world(self) -> Pose:
        """Origin and heading of the torso."""
        truth = self.truth
        return Pose(*truth.position_torso_in_world, truth.heading_in_world)

    @property
    def maneuvers(self) -> ManeuverWalk | None:
        """Walk of a robot that plans its steps."""
        return None

    @property
    def zmp(self) -> tuple[float, float] | None:
        """Center of its foot forces in the world, in [m]; NaN in flight."""
        return None

    @property
    def pushes(self) -> tuple[ScheduledPush, ...]:
        """Pushes that have been applied or scheduled."""
        return ()

    @property
    def begun(self) -> StepStarted | None:
        """Step begun at the last tick, if any."""
        return None

    @property
    def reports(self) -> "Sequence[FrameReport]":
        """Detections of the images that arrived at the last tick."""
        return ()

    @property
    def is_ready(self) -> bool:
        """Whether it is ready for the game to begin."""
        return True

    @property
    def is_moving(self) -> bool:
        """Whether it has left its standing state."""
        return True

    @property
    def has_fallen(self) -> bool:
        """Whether it has fallen, or has detected a fall."""
        return False

    def start(self) -> None:
        """Receive the signal that the game begins."""

    def tick(self) -> None:
        """Perceive, decide and act; physics advances afterwards.

        Raises:
            ReachError: If its legs cannot reach their references.
            StrategyError: If its strategy gives no intent.
        """

    def sample(self, *, closely: bool) -> dict[str, Any]:
        """Return its present motion, by name in a trajectory.

        Closely with all that is measured of it.
        """
        return {
            "com": self.truth.position_com_in_world,
            "place": self.place_in_world,
            "torso": self.torso_in_world,
        }

    def push(self, *pushes: Push) -> None:
        """Schedule pushes of the torso, now or later.

        Raises:
            ConfigurationError: If the player cannot be pushed.
        """
        raise ConfigurationError(
            f"only a robot can be pushed, got {self.name}"
        )

    def close(self) -> None:
        """Release its resources."""


class MarkerBody:
    """Marker of a unicycle or of a recorded player, without contacts."""

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
    """Player that physics does not move."""

    def __init__(
        self,
        body: PersonBody | MarkerBody,
        motion: FloorMotion,
        seen: Callable[[], Seen],
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
