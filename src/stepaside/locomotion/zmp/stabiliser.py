r"""Stabiliser of a plan: ZMP shift, ankle tilt and footstep adjustment.

Small errors are left to the stiff joints. Beyond a dead zone the reference
follows the error: it carries a shift of CoM and DCM from the plan that
grows towards the measured error, and that a shift of the ZMP, as far as the
sole allows, brings back to zero. Both follow the linear inverted pendulum,

.. math:: \dot{\delta\xi} = \eta (\delta\xi - \delta p), \qquad
   \dot{\delta x} = \eta (\delta\xi - \delta x).

The landing of the swing foot shifts for the error that the sole cannot hold.
At the end of the step the next plan begins at the shifted state; with the
method "measured" at the measured state, as far as the correction of that
plan stays in the sole.
"""

from collections import deque
from math import atan2, exp, hypot
from typing import NamedTuple

import numpy as np

from ...core.compilation import bound, compiled
from ...core.poses import Array, Pose, wrap_angle
from ...perception.measurement import RobotState
from ...planning import CenterState, Foot, GaitSettings, ManeuverPlan
from ...planning.schedule import swing_progress
from ...robots.description import RobotDescription
from ...robots.forward_kinematics import ForwardKinematics, MeasuredPosture
from ...robots.leg_kinematics import BodyReference, LegKinematics
from ..control_settings import ControlSettings, StabiliserSettings
from ..locomotion import CurrentStep
from .current_step import (
    adapted_landing,
    beyond,
    clip_to,
    moved_swing,
    shifted_swing,
    zmp_box,
)
from .mpc import IntrinsicallyStableMpc
from .open_loop import LoadFeedforward, OpenLoop, PlanFrom, StepAt, Vector
from .reference_table import ReferenceSample, ReferenceTable
from .state_estimator import BodyState, StateEstimator

ZERO = (0.0, 0.0)
FREEZE = 0.95  # fraction of the swing after which the footstep is fixed
ANKLE_BANDWIDTH = 50.0  # of the filter of the tilt of the stance foot [1/s]
MAX_TURN = 0.08  # of the learned correction of a footstep [rad]
STRIDE_BOUND = 0.056  # of that of its place, by the CoM height
JOINT_BOUND = 0.03  # largest correction of a joint [rad]


class StabiliserTargets(NamedTuple):
    """Commanded motion of the body at one tick, in odometry."""

    body: BodyReference
    dcm: Vector  # [m]
    acceleration: Vector  # of the CoM [m/s^2]
    reaction: Vector  # shift of the ZMP by the swing leg [m]


class Stabiliser(OpenLoop):
    """Feedback controller of one walking robot.

    Errors and shifts are in odometry, in [m]: an error is the measured value
    less its command, beyond the dead zone; a shift the reference less the
    plan's.
    """

    feels = True

    def __init__(
        self,
        settings: ControlSettings,
        estimator: StateEstimator,
        gait: GaitSettings,
        kinematics: LegKinematics,
        feedforward: LoadFeedforward | None = None,
        *,
        tick: float,
        delay: float = 0.0,
        lean: float = 0.0,
    ) -> None:
        """Prepare the stabiliser.

        ``delay`` is the time from a command to the motion, in [s]; for
        ``lean`` see :meth:`BodyReference.roll`.
        """
        super().__init__(kinematics, feedforward)
        self.settings, self.estimator = settings, estimator
        self.tilt, self.measured_heading, self.ready = ZERO, 0.0, False
        self.error: Vector = ZERO  # of the DCM
        self.com_error: Vector = ZERO
        self.com_shift: Vector = ZERO
        self.dcm_shift: Vector = ZERO
        self.zmp_shift: Vector = ZERO
        self.step_shift: Vector = ZERO  # of the landing of the swing foot
        gains = settings.stabiliser
        self.joints = JointCorrection(gains, tick=tick, delay=delay)
        self._gait, self.tick, self.lean = gait, tick, lean
        self._grow = exp(gait.eta * tick)
        self._boxes = {foot: zmp_box(foot, gait, gains.edge) for foot in Foot}
        self.mpc: IntrinsicallyStableMpc | None = None
        if settings.method == "mpc":
            edge = gains.edge
            self.mpc = IntrinsicallyStableMpc(gait, settings.mpc, edge=edge)
        self._ankles = Ankles(gains, tick)
        self._stride = StrideLearning(gait, gains.stride_gain)
        self._angles: Array | None = None  # of the last measurement
        self._asked: deque[StabiliserTargets] = deque(
            maxlen=max(1, round(delay / tick) + 1)
        )

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
        sample = table.sample(index)
        body = self.update(measurement, sample, step(measurement.time))
        self.commanded = body
        if self.state is not None and self.state.has_fallen:
            return None
        angles = measurement.joint_positions
        targets = self._kinematics.track(body)
        corrected = self.joints.update(angles, targets)
        if self.feedforward is None:
            return corrected
        (x, y), (u, v) = sample.zmp, self.zmp_shift
        share = self.settings.stabiliser.load_share
        return corrected + share * self.feedforward.added(body, (x + u, y + v))

    def update(
        self, measurement: RobotState, row: ReferenceSample, step: CurrentStep
    ) -> BodyReference:
        """Run one control tick; return the commanded body."""
        self._observe(measurement, row, step)
        if not self.ready:
            return row.body
        self._react(step)
        body = shifted_swing(row.body, step, self.step_shift)
        body = self._stride.aimed(body, step)
        x, y, z = row.body.com
        assert self.state is not None
        commanded = self._asked[0].body
        left, right = self._ankles.tilts(self.state, commanded.roll(self.lean))
        com = (x + self.com_shift[0], y + self.com_shift[1], z)
        return BodyReference(com, body.left_foot, body.right_foot, left, right)

    def _observe(
        self, measurement: RobotState, row: ReferenceSample, step: CurrentStep
    ) -> None:
        """Estimate the state and its errors from the delayed command."""
        x, y, z = row.body.com
        x, y = x + self.com_shift[0], y + self.com_shift[1]
        square = self._gait.eta**2
        u, v = row.reaction
        shifted = shifted_swing(row.body, step, self.step_shift)
        self._asked.append(
            StabiliserTargets(
                BodyReference((x, y, z), *shifted[1:]),
                (
                    row.dcm[0] + self.dcm_shift[0],
                    row.dcm[1] + self.dcm_shift[1],
                ),
                (
                    square * (x - row.zmp[0] - self.zmp_shift[0] + u),
                    square * (y - row.zmp[1] - self.zmp_shift[1] + v),
                ),
                row.reaction,
            )
        )
        commanded = self._asked[0]
        state = self.estimator.update(
            measurement,
            commanded.body,
            commanded.acceleration,
            commanded.reaction,
        )
        self.state, self.tilt = state, state.tilt
        self._angles = measurement.joint_positions
        self.ready = self.estimator.ready
        self.measured_heading = self.estimator.torso_heading
        dead = self.settings.stabiliser.dead_zone
        self.error = beyond(
            state.dcm[0] - commanded.dcm[0],
            state.dcm[1] - commanded.dcm[1],
            dead,
        )
        self.com_error = beyond(
            state.com[0] - commanded.body.com[0],
            state.com[1] - commanded.body.com[1],
            0.5 * dead,
        )

    def _react(self, step: CurrentStep) -> None:
        """Let the shifts follow the errors, and bring them back."""
        gains, tick, eta = self.settings.stabiliser, self.tick, self._gait.eta
        rate = min(1.0, gains.yielding * tick)
        dx = self.dcm_shift[0] + rate * self.error[0]
        dy = self.dcm_shift[1] + rate * self.error[1]
        cx = self.com_shift[0] + rate * self.com_error[0]
        cy = self.com_shift[1] + rate * self.com_error[1]
        px, py = self.zmp_response(step, (dx, dy), self.zmp_shift)
        dx = px + self._grow * (dx - px)
        dy = py + self._grow * (dy - py)
        self.zmp_shift = px, py
        self.dcm_shift = dx, dy
        self.com_shift = (
            cx + tick * eta * (dx - cx),
            cy + tick * eta * (dy - cy),
        )
        if step.walking and step.remaining > 0.0:
            if step.progress < FREEZE:
                rest = 1.0 - rate
                ex, ey = dx + rest * self.error[0], dy + rest * self.error[1]
                self._adapt(step.to_support(ex, ey), step)

    def zmp_response(
        self, step: CurrentStep, dcm: Vector, zmp: Vector
    ) -> Vector:
        """Return the next ZMP shift, for shifts of DCM and ZMP.

        By the MPC, or a multiple of the DCM shift within the sole.
        """
        self.solved = None
        if self.mpc is None or step.plan is None:
            u, v = step.to_support(*dcm)
            gain = self.settings.stabiliser.feedback
            inside = clip_to((gain * u, gain * v), self._boxes[step.swing])
            return step.from_support(*inside)
        if dcm == zmp == ZERO:
            return zmp  # the plan itself is optimal
        self.solved = self.mpc.solve(
            step.plan,
            step.passed,
            np.array(step.to_support(*dcm)),
            np.array(step.to_support(*zmp)),
        )
        vx, vy = step.from_support(*self.solved.velocity)
        return zmp[0] + self.tick * vx, zmp[1] + self.tick * vy

    def _adapt(self, error: Vector, step: CurrentStep) -> None:
        """Shift the landing at a bounded rate, which the foot can follow."""
        gains = self.settings.stabiliser
        box = self._boxes[step.swing]
        goal = adapted_landing(error, step, box, self._gait, gains)
        reach = gains.step_speed * self.tick
        u, v = self.step_shift
        self.step_shift = (
            u + min(max(goal[0] - u, -reach), reach),
            v + min(max(goal[1] - v, -reach), reach),
        )

    def land(
        self,
        landed: Pose,
        position: Vector,
        velocity: Vector,
        step: CurrentStep,
    ) -> tuple[Pose, Vector, Vector]:
        """Add the shifts to the planned state when a step ends."""
        eta = self._gait.eta
        u, v = self.step_shift
        cx, cy = self.com_shift
        dx, dy = self.dcm_shift
        if self.settings.method != "closed-form":
            cx, cy = cx + self.com_error[0], cy + self.com_error[1]
            dx, dy = dx + self.error[0], dy + self.error[1]
        turn = Pose(0.0, 0.0, -landed.theta)
        x, y, _ = turn.compose(Pose(cx - u, cy - v, 0.0))
        vx, vy, _ = turn.compose(Pose(eta * (dx - cx), eta * (dy - cy), 0.0))
        if hypot(u, v) > 1e-3:
            self.adapted += 1
        elif self._angles is not None:
            posture = self.estimator.kinematics.posture(self._angles)
            self._stride.learn(posture, step)
        self.com_shift = self.dcm_shift = self.step_shift = ZERO
        return (
            Pose(landed.x + u, landed.y + v, landed.theta),
            (position[0] + x, position[1] + y),
            (velocity[0] + vx, velocity[1] + vy),
        )

    def fit(
        self, plan_from: PlanFrom, state: CenterState, support: Pose
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan with the correction inside the sole; the rest is a shift."""
        plan = plan_from(state)
        box = self._boxes[plan.first_foot]
        weight = float(plan.schedule.dcm_start_map[-2])
        x, y = plan.correction.tolist()
        inside = clip_to((x, y), box)
        excess = Pose((x - inside[0]) * weight, (y - inside[1]) * weight, 0.0)
        if excess[:2] != ZERO:
            eta, (vx, vy) = self._gait.eta, state.velocity
            velocity = (vx - eta * excess.x, vy - eta * excess.y)
            state = CenterState(state.position, velocity)
            plan = plan_from(state)
            turned = Pose(0.0, 0.0, support.theta).compose(excess)
            self.dcm_shift = turned[:2]
        return plan, state


@compiled
def correct(
    measured: Array,
    past: Array,
    correction: Array,
    gain: float,
    keep: float,
    most: float,
) -> None:
    """Integrate the joint errors of one tick."""
    for i in range(measured.shape[0]):
        error = (past[i] - measured[i]) * gain
        error += keep * correction[i]
        correction[i] = max(min(error, most), -most)


class Ankles:
    """Ankle feedback: tilts the loaded feet to rotate the body upright."""

    def __init__(self, gains: StabiliserSettings, tick: float) -> None:
        self._gains, self._tick = gains, tick
        self._reference_roll = 0.0
        self._blend = min(1.0, ANKLE_BANDWIDTH * tick)
        self._tilts = (0.0, 0.0, 0.0, 0.0)

    def tilts(
        self, state: BodyState, reference_roll: float = 0.0
    ) -> tuple[Vector, Vector]:
        """Return roll and pitch of the left and the right foot, in [rad]."""
        gains, blend = self._gains, self._blend
        tilt = state.tilt[0] - reference_roll
        rate = (
            state.rate[0]
            - (reference_roll - self._reference_roll) / self._tick
        )
        self._reference_roll = reference_roll
        roll = gains.ankle * tilt + gains.ankle_rate * rate
        pitch = gains.ankle * state.tilt[1] + gains.ankle_rate * state.rate[1]
        left = min(1.0, 2.0 * state.left_share)
        right = min(1.0, 2.0 - 2.0 * state.left_share)
        a, b, c, d = self._tilts
        self._tilts = (
            a + blend * (left * roll - a),
            b + blend * (left * pitch - b),
            c + blend * (right * roll - c),
            d + blend * (right * pitch - d),
        )
        return self._tilts[:2], self._tilts[2:]


class JointCorrection:
    """Bounded, leaky integral of the errors by backlash and load."""

    def __init__(
        self, gains: StabiliserSettings, *, tick: float, delay: float
    ) -> None:
        """Begin without a correction; the delay is of the motion, in [s]."""
        self._gain = gains.joint_gain * tick
        self._keep = 1.0 - gains.joint_leak * tick
        # The servo ramps to a target over one more tick.
        self._targets: deque[Array] = deque(maxlen=round(delay / tick) + 2)
        self._correction: Array | None = None
        self._bind(1)  # compiles

    def update(self, measured: Array, targets: Array) -> Array:
        """Return the corrected targets of one tick, in [rad]."""
        if self._correction is None:
            self._correction = self._bind(len(targets))
        if len(self._targets) == self._targets.maxlen:
            self._measured[:], self._past[:] = measured, self._targets[0]
            self._correct()
        self._targets.append(targets)
        corrected: Array = targets + self._correction
        return corrected

    def _bind(self, count: int) -> Array:
        """Prepare the integral for a number of joints; return it."""
        self._measured, self._past, correction = np.zeros((3, count))
        self._correct = bound(
            *(correct, self._measured, self._past, correction),
            *(self._gain, self._keep, JOINT_BOUND),
        )
        return correction


class StrideLearning:
    """Correction of the swing foot's target by its previous shortfall.

    With backlash and delay a foot lands a few percent short of its target. The
    correction fades in with the swing, and out again in the double support,
    where the joints only strain.
    """

    def __init__(self, gait: GaitSettings, gain: float) -> None:
        self._gait, self._gain = gait, gain
        bound = STRIDE_BOUND * gait.com_height
        self._bounds = np.array([bound, bound, MAX_TURN])
        self._aims = dict.fromkeys(Foot, [0.0, 0.0, 0.0])

    def learn(self, posture: MeasuredPosture, step: CurrentStep) -> None:
        """Update from the posture at the end of a step."""
        own, other = (0, 1) if step.swing is Foot.LEFT else (1, 0)
        feet, axes = (
            posture.positions_feet_in_torso,
            posture.axes_feet_in_torso,
        )
        x, y, _ = axes[other].T @ (feet[own] - feet[other])
        turn = axes[other].T @ axes[own]
        u, v, theta = step.support.inverse().compose(step.landing)
        missed = wrap_angle(theta - atan2(turn[1, 0], turn[0, 0]))
        short = self._gain * np.array([u - x, v - y, missed])
        aim = np.add(self._aims[step.swing], short)
        aim = np.clip(aim, -self._bounds, self._bounds)
        self._aims[step.swing] = aim.tolist()

    def aimed(self, body: BodyReference, step: CurrentStep) -> BodyReference:
        """Return a reference with the corrected target of the swing foot."""
        if not step.walking:
            return body
        share = step.progress
        if step.remaining < 0.0:
            gait = self._gait if step.plan is None else step.plan.gait
            stood = -step.remaining / gait.double_support
            share = 1.0 - swing_progress(stood)
        x, y, theta = self._aims[step.swing]
        x, y = step.from_support(share * x, share * y)
        return moved_swing(body, step.swing, x, y, share * theta)


def build_stabiliser(
    description: RobotDescription,
    gait: GaitSettings,
    control: ControlSettings,
    kinematics: LegKinematics,
    loads: LoadFeedforward | None,
    *,
    tick: float,
    delay: float,
    forward: ForwardKinematics | None = None,
) -> Stabiliser:
    """Build the feedback; ``forward`` are kinematics of the measured body."""
    forward = forward or ForwardKinematics(description)
    estimator = StateEstimator(
        forward, forward.force_sensors(), gait.eta, tick
    )
    return Stabiliser(
        *(control, estimator, gait, kinematics, loads),
        tick=tick,
        delay=delay,
        lean=description.lean,
    )
