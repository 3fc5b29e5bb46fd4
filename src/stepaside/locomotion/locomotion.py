"""Interface between a controller that decides and one that walks."""

from typing import NamedTuple, Protocol

from ..core.poses import Array, Pose
from ..perception.measurement import RobotState
from ..planning import Direction, Foot, GaitSettings
from ..strategies.knowledge import Intent
from ..strategies.velocity_set import STILL, BodyVelocity, VelocitySet
from ..theory import laws
from .walk_snapshots import Phase, StepStarted, WalkState
from .zmp.current_step import CurrentStep


class MotionRequest(NamedTuple):
    """Decision of a player, for its locomotion.

    Attributes:
        intent: Desired heading and speed, in the frame of the decision, or
            velocity, in that of the body.
        direction: Whether the body drives forward or backward.
        saturated: Whether it turns by (6) instead of (8).
    """

    intent: Intent
    direction: Direction
    saturated: bool


def template_velocity(
    request: MotionRequest, gait: GaitSettings
) -> BodyVelocity:
    """Return the desired velocity of the template.

    It is the desired body velocity, or that of the template unicycle, (3)
    and (8), or (6) if saturated.

    Args:
        request: Decision of the player.
        gait: Speed and steering gain of the template.
    """
    intent = request.intent
    if not intent.walks:
        return STILL
    if intent.velocity is not None:
        return intent.velocity
    speed = request.direction.value * gait.speed * intent.speed_factor
    law = laws.saturated_rate if request.saturated else laws.proportional_rate
    return BodyVelocity(
        speed * intent.pace, 0.0, law(intent.heading, gait.gain) * intent.pace
    )


class IntentSource(Protocol):
    """Decisions of a player, evaluated when its locomotion can use one."""

    def starts(self, now: float) -> bool:
        """Return whether a standing robot starts to walk.

        Args:
            now: Time of the decision, in [s].
        """

    def decide(
        self, now: float, support: Pose, side: Foot, *, moving: bool
    ) -> MotionRequest | None:
        """Decide on the next step.

        Args:
            now: Time at which the step begins, in [s].
            support: Pose of its support foot in odometry: the frame of the
                intent.
            side: Side of the support foot.
            moving: Whether the robot is walking.

        Returns:
            The decision; None if the opponent is lost: the robot halts.
        """


class Locomotion(Protocol):
    """Locomotion of one robot: from decisions to joint targets.

    Poses are in odometry: the frame midway between the feet at the start.

    Attributes:
        gait: Speed, steering gain and timing of its template.
        phase: Phase of motion.
        begun: Step that began at the last tick; None if none did.
    """

    gait: GaitSettings
    phase: Phase
    begun: StepStarted | None

    @property
    def joint_targets(self) -> Array:
        """Joint targets of the last tick, in [rad]. Shape (joints,)."""

    @property
    def velocities(self) -> VelocitySet:
        """Velocities that it delivers."""

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in odometry, in [rad]."""

    @property
    def heading_delay(self) -> float:
        """Time until the torso has that heading, in [s]."""

    @property
    def pose(self) -> Pose:
        """Pose of the template in odometry."""

    @property
    def pose_delay(self) -> float:
        """Time from a tick until the body is at its ``pose``, in [s]."""

    @property
    def tilt(self) -> tuple[float, float] | None:
        """Roll and pitch of the torso, in [rad]; None without an estimate."""

    @property
    def state(self) -> WalkState | None:
        """Plan and references of the last tick; None without a plan."""

    @property
    def feels(self) -> bool:
        """Whether it uses joint angles, IMU or forces on the soles."""

    def step(self, now: float) -> CurrentStep:
        """Return the step in progress at a time, in [s]."""

    def decides(self, now: float) -> bool:
        """Return whether a decision is due at a tick, at a time in [s]."""

    def coast(self, now: float) -> Array | None:
        """Run a control tick that needs neither measurement nor decision.

        Args:
            now: Time of the tick, in [s].

        Returns:
            Joint targets, in [rad], shape (joints,); None if this tick needs
            a measurement or a decision, and then nothing has changed.

        Raises:
            ReachError: If the legs cannot follow the reference.
        """

    def update(
        self, measurement: RobotState, decisions: IntentSource
    ) -> Array:
        """Run one control tick; decide if a decision is due.

        Args:
            measurement: RobotState of the tick.
            decisions: Decisions of the player.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs cannot follow the reference.
            StrategyError: If the strategy returns no intent.
        """
