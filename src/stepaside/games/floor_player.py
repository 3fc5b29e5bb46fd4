"""Players that physics does not move: people, unicycles, recorded motions.

A body on the floor shows the player and gives its true state; a steering
moves it from tick to tick.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

from ..core.errors import ConfigurationError
from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose
from ..locomotion.walk_snapshots import StepStarted
from ..planning import GaitSettings
from ..sim.crowd_motion import CrowdMotion
from ..sim.ground_truth import FloorTruth, GroundTruth
from ..sim.person_motion import PersonMotion
from ..sim.push import Push
from ..sim.template_body import pose_template
from ..sim.world import World
from ..strategies.template_agent import PlayerState, TemplateAgent
from .player import Snapshot, TruthLog
from .recorded_motion import RecordedMotion
from .template_level import PERIOD, FloorBulk, UnicycleMotion

if TYPE_CHECKING:
    from ..perception.pipeline import FrameReport

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
        self.truth.move(pose)
        pose_template(self.world.model, self.world.data, self.name, pose)


class Steering(Protocol):
    """Motion of a body on the floor."""

    def next_pose(self, time: float) -> Pose:
        """Return the pose at the end of the tick that begins at a time [s]."""


class CrowdSteering:
    """Walk of a person to a goal."""

    def __init__(
        self,
        motion: CrowdMotion,
        others: Mapping[str, GroundTruth],
        bodies: Mapping[str, FloorBulk],
        tick: float,
    ) -> None:
        """Take the walk, and true states and bodies of all others."""
        self._motion, self._others = motion, others
        self._bodies, self._tick = bodies, tick
        self._last, self._since = motion.pose, 0.0

    def next_pose(self, time: float) -> Pose:
        """Return the pose at the end of a tick.

        The person decides every 20 ms, as at the other levels, and keeps its
        velocity in between.
        """
        now = time + self._tick
        if now > self._since + 1e-9:
            self._last, self._since = self._motion.pose, self._since + PERIOD
            self._decide(self._since)
        x, y, _ = self._last
        ahead = self._motion.pose
        share = 1.0 - (self._since - now) / PERIOD
        return Pose(
            x + share * (ahead.x - x), y + share * (ahead.y - y), ahead.theta
        )

    def _decide(self, until: float) -> None:
        """Walk for one period, which ends at a time, in [s]."""
        neighbours = [
            self._bodies[name].at(*truth.position_torso_in_world)
            for name, truth in self._others.items()
        ]
        self._motion.advance(until, PERIOD, neighbours)


class PathSteering:
    """Walk of a person along a path relative to another player.

    Attributes:
        motion: The walk.
    """

    def __init__(
        self, motion: PersonMotion, target: GroundTruth, tick: float
    ) -> None:
        """Take the walk and the true state of the other player."""
        self.motion, self._target, self._tick = motion, target, tick

    def next_pose(self, time: float) -> Pose:
        """Return the pose at the end of a tick."""
        target = self._target.position_torso_in_world
        self.motion.advance(time + self._tick, self._tick, target)
        return self.motion.pose


class RecordedSteering:
    """Motion that was recorded."""

    def __init__(self, motion: RecordedMotion, tick: float) -> None:
        """Take a recorded motion."""
        self._motion, self._tick = motion, tick

    def next_pose(self, time: float) -> Pose:
        """Return the pose at the end of a tick."""
        return self._motion.pose_at(time + self._tick)


class StrategySteering:
    """Template unicycle that decides at steps; it moves every 20 ms."""

    def __init__(
        self,
        agent: TemplateAgent,
        pose: Pose,
        gait: GaitSettings,
        identities: dict[str, PlayerIdentity],
        others: Mapping[str, GroundTruth],
    ) -> None:
        """Take a strategy, and the true states of all other players."""
        self._name, self._others = agent.identity.name, others
        self._motion = UnicycleMotion(
            agent, pose, gait, identities, steps=True
        )
        self._players = self._states({})
        self._due = 0.0

    def next_pose(self, time: float) -> Pose:
        """Return the pose at the end of a tick."""
        if time >= self._due - 1e-9:
            self._players = self._states(self._players)
            self._motion.advance(time, self._players)
            self._due += PERIOD
        return self._motion.pose

    def _states(
        self, before: Mapping[str, PlayerState]
    ) -> dict[str, PlayerState]:
        """Return the states of all players, one period after others."""
        poses = {
            name: Pose(*truth.position_reference_in_world, 0.0)
            for name, truth in self._others.items()
        } | {self._name: self._motion.pose}
        states = {}
        for name, pose in poses.items():
            last = before[name].pose if name in before else pose
            dx, dy = pose.x - last.x, pose.y - last.y
            states[name] = PlayerState(pose, (dx / PERIOD, dy / PERIOD))
        return states


class FloorPlayer:
    """Player that physics does not move.

    Attributes:
        name: Name of the player.
        truth: Its true state.
        steering: Its motion.
        begun: None: it plans no footsteps.
        reports: Empty: it has no cameras.
        is_ready: True.
        is_moving: True.
        has_fallen: False: it does not fall.
    """

    begun: StepStarted | None = None
    reports: "Sequence[FrameReport]" = ()
    is_ready = True
    is_moving = True
    has_fallen = False

    def __init__(self, body: FloorBody, steering: Steering) -> None:
        """Combine a body and its motion."""
        self.name, self._body, self.steering = body.name, body, steering
        self.truth: GroundTruth = body.truth

    def start(self) -> None:
        """Do nothing: it begins with the simulation."""

    def tick(self) -> None:
        """Advance the motion by one tick."""
        self._body.move(self.steering.next_pose(self._body.world.time))

    def snapshot(self) -> Snapshot:
        """Return the state at this instant."""
        x, y, z = self.truth.position_com_in_world.tolist()
        pose = self._body.truth.pose
        return Snapshot(
            name=self.name,
            time=self._body.world.time,
            place=pose,
            torso=pose,
            com=(x, y, z),
        )

    def motion_log(self, *, closely: bool) -> TruthLog:
        """Return an empty log of its motion; it has no estimates."""
        return TruthLog(self.truth)

    def push(self, *pushes: Push) -> None:
        """Reject pushes.

        Raises:
            ConfigurationError: Always.
        """
        raise ConfigurationError(
            f"only a robot can be pushed, got {self.name}"
        )

    def close(self) -> None:
        """Do nothing: it holds no resources."""
