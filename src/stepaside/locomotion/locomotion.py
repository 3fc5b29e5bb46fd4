"""Interface between a controller that decides and one that walks."""

from enum import Enum
from math import cos, sin
from typing import NamedTuple, Protocol

from ..arena import NO_OBSTACLES
from ..core.poses import Pose
from ..perception.measurement import RobotState
from ..planning import Direction, Foot, GaitSettings, ManeuverPlan
from ..strategies.knowledge import Intent
from ..strategies.velocity_set import STILL, BodyVelocity
from ..theory import laws


class Phase(Enum):
    """Phase of motion of a robot, by its own estimate."""

    STANDING = "standing"
    WALKING = "walking"
    HALTING = "halting"
    FALLEN = "fallen"


class StepStarted(NamedTuple):
    """Step that began at a tick."""

    plan: ManeuverPlan  # maneuver whose first step it is
    started: float  # start time [s]; not always on a tick
    landing_time: float  # planned landing time [s]
    foot: Foot  # foot that lands
    landing: Pose  # planned landing pose, in odometry
    # processor time of planning [s]; None for a halt
    planning_time: float | None
    velocity_jump: float  # jump of the CoM velocity reference [m/s]


class CurrentStep(NamedTuple):
    """Step in progress, in odometry."""

    support: Pose  # pose of the support foot
    swing: Foot  # foot that swings, or swung last
    landing: Pose  # planned landing pose
    remaining: float  # time until the landing [s]; negative after it
    progress: float  # fraction of the swing path that is completed
    walking: bool  # whether the robot walks; otherwise it stands
    plan: ManeuverPlan | None = None  # plan whose first step this is, if any
    passed: float = 0.0  # time since that plan began [s]

    def to_support(self, x: float, y: float) -> tuple[float, float]:
        """Rotate a vector from odometry to the support foot's axes."""
        c, s = cos(-self.support.theta), sin(-self.support.theta)
        return c * x - s * y, s * x + c * y

    def from_support(self, x: float, y: float) -> tuple[float, float]:
        """Rotate a vector from the support foot's axes to odometry."""
        c, s = cos(self.support.theta), sin(self.support.theta)
        return c * x - s * y, s * x + c * y


def resting_step(support: Pose, foot: Foot) -> CurrentStep:
    """Return the step of a robot that stands on a support, not on a foot."""
    return CurrentStep(support, foot, support, 0.0, 1.0, False)


class MotionRequest(NamedTuple):
    """Decision of a player, for its locomotion."""

    intent: Intent  # heading in the frame of the decision, or body velocity
    direction: Direction  # whether the body drives forward or backward
    saturated: bool  # whether it turns by (6) instead of (8)


def template_velocity(
    request: MotionRequest, gait: GaitSettings
) -> BodyVelocity:
    """Return the desired velocity, or that of the template by (3) and (8).

    By (6) if saturated.
    """
    intent = request.intent
    if not intent.walks:
        return STILL
    if intent.velocity is not None:
        return intent.velocity
    speed = request.direction.value * gait.speed * intent.speed_factor
    law = laws.saturated_rate if request.saturated else laws.proportional_rate
    return BodyVelocity(speed, 0.0, law(intent.heading, gait.gain))


class GuardDecision(NamedTuple):
    """Intent that a guard accepts in place of the requested one."""

    intent: Intent  # heading and speed
    back: bool = False  # whether the driving direction is reversed


class Surroundings:
    """Obstacles known to a robot: none, on an open floor."""

    solids = NO_OBSTACLES
    pose_odometry_in_map = Pose(0.0, 0.0, 0.0)
    map_error = 0.0
    needs_pose = False  # measured in the room, to align odometry

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Update from a measurement; the pose of the CoM is in odometry."""


class IntentSource(Protocol):
    """Decisions of a player, evaluated when its locomotion can use one."""

    def starts(self, now: float) -> bool:
        """Return whether a standing robot starts to walk."""

    def decide(
        self, now: float, support: Pose, side: Foot, *, moving: bool
    ) -> MotionRequest | None:
        """Decide on the next step, in the frame of its support foot.

        The pose is in odometry. None if the opponent is lost: the robot halts.
        """
