"""Locomotion by a walking policy: decisions in, joint targets out."""

from ...core.poses import Array, Pose
from ...perception.measurement import RobotState
from ...planning import Foot, GaitSettings
from ...strategies.knowledge import Intent
from ...strategies.velocity_set import STILL, VelocitySet
from ..guard import VelocityGuard
from ..locomotion import (
    IntentSource,
    Phase,
    StepStarted,
    template_velocity,
)
from ..zmp.current_step import CurrentStep, resting_step
from .policy_legs import PolicyLegs

VELOCITY_INTERVAL = 0.08  # between decisions on a body velocity, in [s]


def decision_interval(intent: Intent, gait: GaitSettings) -> float:
    """Return the time until the next decision of a walking robot, in [s]."""
    walks_by_heading = intent.velocity is None
    return gait.step_duration if walks_by_heading else VELOCITY_INTERVAL


class PolicyWalk:
    """Walk of one robot by a policy, with decisions at fixed intervals.

    A heading is walked for the step of the template, a body velocity for
    0.08 s.
    """

    begun: StepStarted | None = None  # none: a policy plans no steps
    maneuvers: None = None  # likewise
    heading_delay = pose_delay = 0.0
    feels = True

    def __init__(
        self,
        legs: PolicyLegs,
        gait: GaitSettings,
        guard: VelocityGuard | None = None,
    ) -> None:
        """Begin standing, with a guard against obstacles, if any."""
        self.legs, self.gait, self._guard = legs, gait, guard
        self.phase = Phase.STANDING
        self._velocity = STILL
        self._next_decision = 0.0

    @property
    def joint_targets(self) -> Array:
        """Joint targets of the last tick, in [rad]. Shape (joints,)."""
        return self.legs.joint_targets

    @property
    def velocities(self) -> VelocitySet:
        """Velocities that it delivers, and how fast."""
        return self.legs.velocities

    @property
    def torso_heading(self) -> float:
        """Heading of the torso in odometry, in [rad]."""
        return self.legs.pose.theta

    @property
    def pose(self) -> Pose:
        """Pose of the template: place of the CoM and heading of the torso."""
        return self.legs.pose

    @property
    def tilt(self) -> tuple[float, float] | None:
        """Roll and pitch of the torso, in [rad]."""
        return self.legs.tilt

    def step(self, now: float) -> CurrentStep:
        """Return a step that rests on the loaded foot: none is planned."""
        support, side = self.legs.odometry.stance
        return resting_step(support, side.other)

    @property
    def _support(self) -> Pose:
        """Left foot of a robot that stands at the present pose."""
        half = 0.5 * self.gait.foot_spacing
        return self.legs.pose.compose(Pose(0.0, half, 0.0))

    def decides(self, now: float) -> bool:
        """Return whether a decision is due at a tick, at a time in [s]."""
        if self.phase is Phase.STANDING:
            return self.legs.ready
        return now >= self._next_decision - 1e-9

    def coast(self, now: float) -> None:
        """Return None: every tick needs a measurement."""

    def update(
        self, measurement: RobotState, decisions: IntentSource
    ) -> Array:
        """Return the joint targets of a tick, in [rad]; decide if due."""
        now = measurement.time
        stands = self.phase is Phase.STANDING
        if self._guard is not None:
            self._guard.note(measurement, self.pose)
        if self.decides(now) and (not stands or decisions.starts(now)):
            self._decide(now, decisions)
        return self.legs.update(measurement, self._velocity)

    def _decide(self, now: float, decisions: IntentSource) -> None:
        """Request a decision, and follow it until the next one."""
        moving = self.phase is not Phase.STANDING
        request = decisions.decide(
            now, self._support, Foot.LEFT, moving=moving
        )
        self._velocity, interval = STILL, self.gait.step_duration
        if request is not None:
            self._velocity = template_velocity(request, self.gait)
            interval = decision_interval(request.intent, self.gait)
        if self._guard is not None:
            self._velocity = self._guard.admit(
                self._velocity, self.legs.pose, interval
            )
        walks = self._velocity != STILL
        self.phase = Phase.WALKING if walks else Phase.STANDING
        self._next_decision = now + interval
