"""Balance control between plan and joints: open loop or feedback."""

from collections.abc import Callable

import numpy as np

from ...core.poses import Array, Pose
from ...perception.measurement import RobotState
from ...planning import CenterState, GaitSettings, ManeuverPlan
from ...robots.description import RobotDescription
from ...robots.forward_kinematics import ForwardKinematics
from ...robots.leg_kinematics import BodyReference, LegKinematics
from .control_settings import ControlSettings
from .current_step import CurrentStep
from .feedforward import LoadFeedforward
from .mpc import MpcResult
from .reference_table import ReferenceTable
from .stabiliser import Stabiliser
from .state_estimator import BodyState, StateEstimator

STANDING_TICKS = 64  # computed at once
Vector = tuple[float, float]
PlanFrom = Callable[[CenterState], ManeuverPlan]
StepAt = Callable[[float], CurrentStep]


class OpenLoop:
    """Joint targets of the plan as it is, on stiff joints.

    The targets of a whole step are computed at once. Where a joint limit
    acts, they are computed tick by tick.

    Attributes:
        state: Last estimate of the body's state, if any.
        solved: Result of the MPC at this tick, if it ran.
        adapted: Number of footsteps moved so far.
        commanded: Body reference of the last tick, if feedback changes it.
        ready: Whether the robot may begin to walk.
        tilt: Roll and pitch of the torso, in [rad]; None without an estimate.
        measured_heading: Measured heading of the torso in odometry, in [rad].
        planned_heading: Heading of the torso of the last targets, in [rad].
    """

    state: BodyState | None = None
    solved: MpcResult | None = None
    adapted = 0
    commanded: BodyReference | None = None
    ready = True
    tilt: Vector | None = None
    measured_heading: float | None = None

    def __init__(
        self,
        kinematics: LegKinematics,
        feedforward: LoadFeedforward | None = None,
    ) -> None:
        """Prepare the open loop, with load feedforward if given."""
        self._kinematics = kinematics
        self.feedforward = feedforward
        self._references: Array | None = None  # of the computed ticks
        self._targets: list[Array] = []
        self._headings: list[float] = []
        self._used = 0  # number of the computed ticks that were used
        self._index = 0  # of the last tick in the table

    def targets(
        self,
        measurement: RobotState,
        table: ReferenceTable,
        index: int,
        step: StepAt,
    ) -> Array:
        """Return the joint targets of a tick of the table, in [rad].

        Shape (joints,); with feedback None after a fall.

        Raises:
            ReachError: If the legs cannot follow the reference.
        """
        return self.planned_targets(table, index)

    def planned_targets(self, table: ReferenceTable, index: int) -> Array:
        """Return the same if it needs no measurement; None with feedback."""
        used = self._used
        if (
            used == len(self._targets)
            or index != self._index + 1
            or table.references is not self._references
        ):
            self._compute(table, index)
            used = 0
        self._index, self._used = index, used + 1
        return self._targets[used]

    @property
    def planned_heading(self) -> float:
        """Heading of the torso of the last targets, in [rad]."""
        if not self._headings:
            return self._kinematics.torso_heading
        return self._headings[self._used - 1]

    def _compute(self, table: ReferenceTable, index: int) -> None:
        """Compute the targets from a tick on, up to one out of reach."""
        kinematics, feedforward = self._kinematics, self.feedforward
        if self._used < len(self._targets):
            kinematics.rewind(self._used)
            if feedforward is not None:
                feedforward.rewind(self._used)
        self._references, self._targets, self._used = table.references, [], 0
        last = len(table.references) - 1
        rows = slice(min(index, last), last + 1)
        references, zmp = table.references[rows], table.zmp[rows]
        if last == 0:  # standing
            references = np.repeat(references, STANDING_TICKS, axis=0)
            zmp = np.repeat(zmp, STANDING_TICKS, axis=0)
        states = kinematics.track_rows(references)
        targets, count = states.targets, len(states.targets)
        self._headings = states.torso_headings
        if feedforward is not None:
            targets = targets + feedforward.offset_rows(
                states.rows, references[:count], zmp[:count]
            )
        self._targets = list(targets)

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Return the landed foot, and CoM and velocity in it, as planned."""
        return landed, position, velocity

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan with the correction inside the sole; here, as planned."""
        return plan_from(state), state


class ClosedLoop:
    """Feedback by a stabiliser; members are those of :class:`OpenLoop`."""

    def __init__(
        self,
        stabiliser: Stabiliser,
        kinematics: LegKinematics,
        feedforward: LoadFeedforward | None = None,
    ) -> None:
        """Prepare the closed loop, with load feedforward if given."""
        self.stabiliser = stabiliser
        self._kinematics = kinematics
        self.feedforward = feedforward
        self.commanded: BodyReference | None = None

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
    def tilt(self) -> Vector | None:
        """Roll and pitch of the torso, in [rad]."""
        return self.stabiliser.estimator.tilt

    @property
    def measured_heading(self) -> float | None:
        """Heading of the torso over the loaded foot, in [rad]."""
        return self.stabiliser.estimator.torso_heading

    @property
    def planned_heading(self) -> float:
        """Heading of the torso of the last targets, in [rad]."""
        return self._kinematics.torso_heading

    def planned_targets(self, table: ReferenceTable, index: int) -> None:
        """Return None: every tick needs a measurement."""

    def targets(
        self,
        measurement: RobotState,
        table: ReferenceTable,
        index: int,
        step: StepAt,
    ) -> Array | None:
        """Return the targets of the stabilised reference."""
        stabiliser, sample = self.stabiliser, table.sample(index)
        body = stabiliser.update(measurement, sample, step(measurement.time))
        self.commanded = body
        if stabiliser.state is not None and stabiliser.state.has_fallen:
            return None
        angles = measurement.joint_positions
        targets = self._kinematics.track(body)
        corrected = stabiliser.joints.update(angles, targets)
        if self.feedforward is None:
            return corrected
        (x, y), (u, v) = sample.zmp, stabiliser.zmp_shift
        share = stabiliser.settings.stabiliser.load_share
        return corrected + share * self.feedforward.added(body, (x + u, y + v))

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


Balance = OpenLoop | ClosedLoop


def build_balance(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    *,
    tick: float,
    delay: float,
    kinematics: LegKinematics,
    forward: ForwardKinematics | None = None,
) -> Balance:
    """Build the balance control that the settings select.

    Args:
        description: Robot description.
        gait: Gait.
        control: Control settings.
        tick: Control period, in [s].
        delay: Time from a command to the motion, in [s].
        kinematics: Joint motion generation of the robot.
        forward: Kinematics of the measured body; built if not given.
    """
    loads = None
    if not control.feedback or control.stabiliser.load_share > 0.0:
        loads = LoadFeedforward(
            kinematics, zmp_forward=gait.zmp_forward, tick=tick
        )
    if not control.feedback:
        return OpenLoop(kinematics, loads)
    forward = forward or ForwardKinematics(description)
    estimator = StateEstimator(
        forward, forward.force_sensors(), gait.eta, tick
    )
    return ClosedLoop(
        Stabiliser(
            control,
            estimator,
            gait,
            tick=tick,
            delay=delay,
            lean=description.lean,
        ),
        kinematics,
        loads,
    )
