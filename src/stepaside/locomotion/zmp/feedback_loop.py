"""What keeps a walking robot up: nothing, or feedback."""

from collections.abc import Callable
from typing import Protocol

from ...core.poses import Array, Pose
from ...perception.measurement import Measurement
from ...planning import CenterState, ManeuverPlan
from ...robots.leg_kinematics import BodyReference
from .current_step import CurrentStep
from .feedforward import LoadFeedforward
from .mpc import MpcResult
from .reference_table import ReferenceSample
from .stabiliser import Stabiliser
from .state_estimator import BodyState

Vector = tuple[float, float]
PlanFrom = Callable[[CenterState], ManeuverPlan]
StepAt = Callable[[float], CurrentStep]


class Balance(Protocol):
    """A part of control between the plan and the joints.

    Attributes:
        state: Last estimate of the body's state, if there is one.
        solved: Answer of a solver at this tick, if it was asked.
        adapted: Footsteps that were moved so far.
    """

    @property
    def state(self) -> BodyState | None:
        """Last estimate of the body's state, if there is one."""

    @property
    def solved(self) -> MpcResult | None:
        """Answer of a solver at this tick, if it was asked."""

    @property
    def adapted(self) -> int:
        """Footsteps that were moved so far."""

    @property
    def ready(self) -> bool:
        """Whether the robot may begin to walk."""

    @property
    def has_fallen(self) -> bool:
        """Whether the robot feels that it falls."""

    @property
    def tilt(self) -> Vector | None:
        """Roll and pitch of the torso, in [rad]; None if nobody knows."""

    @property
    def torso_heading(self) -> float | None:
        """Measured heading of the torso in odometry, in [rad]."""

    def update(
        self, measurement: Measurement, sample: ReferenceSample, step: StepAt
    ) -> BodyReference:
        """What to ask of the body at one tick.

        Args:
            measurement: What the sensors give.
            sample: What the plan asks for.
            step: Step being made at a time, in [s].
        """

    def correct(self, measurement: Measurement, targets: Array) -> Array:
        """Joint targets with what the joints miss, in [rad]."""

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Foot, CoM and its velocity at the end of a step, as believed."""

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan so that the correction stays inside the sole."""


class OpenLoop:
    """The plan as it is: the joints are stiff, and nothing is measured.

    Attributes:
        state: None.
        solved: None.
        adapted: 0.
        ready: True.
        has_fallen: False.
        tilt: None.
        torso_heading: None.
    """

    state: BodyState | None = None
    solved: MpcResult | None = None
    adapted = 0
    ready = True
    has_fallen = False
    tilt: Vector | None = None
    torso_heading: float | None = None

    def __init__(self, feedforward: LoadFeedforward | None = None) -> None:
        """Trust the joints, or know how they give way under load."""
        self._feedforward = feedforward
        self._sample: ReferenceSample | None = None

    def update(
        self, measurement: Measurement, sample: ReferenceSample, step: StepAt
    ) -> BodyReference:
        """Pass the reference on."""
        self._sample = sample
        return sample.body

    def correct(self, measurement: Measurement, targets: Array) -> Array:
        """Pass the targets on, with what the servos give way."""
        if self._feedforward is None or self._sample is None:
            return targets
        body, zmp = self._sample.body, self._sample.zmp
        return targets + self._feedforward.added(body, zmp)

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Believe that the plan was followed."""
        return landed, position, velocity

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan from where the last plan ends."""
        return plan_from(state), state


class ClosedLoop:
    """Feedback by a stabiliser.

    Attributes:
        stabiliser: What feeds back.
    """

    def __init__(
        self,
        stabiliser: Stabiliser,
        feedforward: LoadFeedforward | None = None,
    ) -> None:
        """Close the loop; what the servos give way may be known besides."""
        self.stabiliser = stabiliser
        self._feedforward = feedforward
        self._asked: tuple[BodyReference, Vector] | None = None

    @property
    def state(self) -> BodyState | None:
        """Last estimate of the body's state."""
        return self.stabiliser.state

    @property
    def solved(self) -> MpcResult | None:
        """Answer of the MPC at this tick, if it was asked."""
        return self.stabiliser.zmp_feedback.solved

    @property
    def adapted(self) -> int:
        """Footsteps that were moved so far."""
        return self.stabiliser.adapted

    @property
    def ready(self) -> bool:
        """Whether the robot has stood still long enough."""
        return self.stabiliser.ready

    @property
    def has_fallen(self) -> bool:
        """Whether the torso leans too far to come back."""
        state = self.stabiliser.state
        return state is not None and state.has_fallen

    @property
    def tilt(self) -> Vector | None:
        """Roll and pitch of the torso, in [rad]."""
        return self.stabiliser.estimator.tilt

    @property
    def torso_heading(self) -> float | None:
        """Heading of the torso over the loaded foot, in [rad]."""
        return self.stabiliser.estimator.torso_heading

    def update(
        self, measurement: Measurement, sample: ReferenceSample, step: StepAt
    ) -> BodyReference:
        """Let the reference give way; see :class:`Stabiliser`."""
        made = step(measurement.time)
        body = self.stabiliser.update(measurement, sample, made)
        (x, y), (u, v) = sample.zmp, self.stabiliser.zmp_shift
        self._asked = body, (x + u, y + v)
        return body

    def correct(self, measurement: Measurement, targets: Array) -> Array:
        """Ask on top for what the joints miss, and what they will miss."""
        angles = measurement.joint_positions
        corrected = self.stabiliser.joints.update(angles, targets)
        if self._feedforward is None or self._asked is None:
            return corrected
        share = self.stabiliser.settings.stabiliser.load_share
        return corrected + share * self._feedforward.added(*self._asked)

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Take the shifts over into the next plan."""
        return self.stabiliser.land(landed, position, velocity, step)

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan so that the correction stays inside the sole."""
        return self.stabiliser.fit(plan_from, state, support)
