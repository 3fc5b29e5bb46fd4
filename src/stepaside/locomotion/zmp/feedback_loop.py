"""Balance control between plan and joints: open loop or feedback."""

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
    """Balance control between the plan and the joints.

    Attributes:
        state: Last estimate of the body's state, if any.
        solved: Result of the MPC at this tick, if it ran.
        adapted: Number of footsteps moved so far.
    """

    @property
    def state(self) -> BodyState | None:
        """Last estimate of the body's state, if any."""

    @property
    def solved(self) -> MpcResult | None:
        """Result of the MPC at this tick, if it ran."""

    @property
    def adapted(self) -> int:
        """Number of footsteps moved so far."""

    @property
    def ready(self) -> bool:
        """Whether the robot may begin to walk."""

    @property
    def has_fallen(self) -> bool:
        """Whether the estimate detects a fall."""

    @property
    def tilt(self) -> Vector | None:
        """Roll and pitch of the torso, in [rad]; None without an estimate."""

    @property
    def torso_heading(self) -> float | None:
        """Measured heading of the torso in odometry, in [rad]."""

    def update(
        self, measurement: Measurement, sample: ReferenceSample, step: StepAt
    ) -> BodyReference:
        """Return the body reference of one tick.

        Args:
            measurement: Measurement of the tick.
            sample: Reference of the plan.
            step: Function from a time, in [s], to the step in progress.
        """

    def correct(self, measurement: Measurement, targets: Array) -> Array:
        """Return corrected joint targets, in [rad]."""

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Return the estimated landing, CoM and velocity after a step."""

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan with the correction inside the sole."""


class OpenLoop:
    """Open loop: the plan as it is, on stiff joints.

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
        """Prepare the open loop, with load feedforward if given."""
        self._feedforward = feedforward
        self._sample: ReferenceSample | None = None

    def update(
        self, measurement: Measurement, sample: ReferenceSample, step: StepAt
    ) -> BodyReference:
        """Return the reference of the plan."""
        self._sample = sample
        return sample.body

    def correct(self, measurement: Measurement, targets: Array) -> Array:
        """Return the targets with the load feedforward, if any."""
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
        """Return the planned state."""
        return landed, position, velocity

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan from the planned state."""
        return plan_from(state), state


class ClosedLoop:
    """Feedback by a stabiliser.

    Attributes:
        stabiliser: The stabiliser.
    """

    def __init__(
        self,
        stabiliser: Stabiliser,
        feedforward: LoadFeedforward | None = None,
    ) -> None:
        """Prepare the closed loop, with load feedforward if given."""
        self.stabiliser = stabiliser
        self._feedforward = feedforward
        self._commanded: tuple[BodyReference, Vector] | None = None

    @property
    def state(self) -> BodyState | None:
        """Last estimate of the body's state."""
        return self.stabiliser.state

    @property
    def solved(self) -> MpcResult | None:
        """Result of the MPC at this tick, if it ran."""
        return self.stabiliser.zmp_feedback.solved

    @property
    def adapted(self) -> int:
        """Number of footsteps moved so far."""
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
        """Return the stabilised reference; see :class:`Stabiliser`."""
        current = step(measurement.time)
        body = self.stabiliser.update(measurement, sample, current)
        (x, y), (u, v) = sample.zmp, self.stabiliser.zmp_shift
        self._commanded = body, (x + u, y + v)
        return body

    def correct(self, measurement: Measurement, targets: Array) -> Array:
        """Add the joint correction and the load feedforward."""
        angles = measurement.joint_positions
        corrected = self.stabiliser.joints.update(angles, targets)
        if self._feedforward is None or self._commanded is None:
            return corrected
        share = self.stabiliser.settings.stabiliser.load_share
        return corrected + share * self._feedforward.added(*self._commanded)

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Add the shifts to the state for the next plan."""
        return self.stabiliser.land(landed, position, velocity, step)

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan with the correction inside the sole."""
        return self.stabiliser.fit(plan_from, state, support)
