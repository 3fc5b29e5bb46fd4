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
from collections.abc import Callable
from math import exp, hypot
from typing import NamedTuple

from ...core.poses import Pose
from ...perception.measurement import RobotState
from ...planning import CenterState, Foot, GaitSettings, ManeuverPlan
from ...robots.leg_kinematics import BodyReference
from .control_settings import ControlSettings
from .current_step import (
    CurrentStep,
    adapted_landing,
    beyond,
    clip_to,
    shifted_swing,
    zmp_box,
)
from .joint_correction import Ankles, JointCorrection
from .reference_table import ReferenceSample
from .state_estimator import BodyState, StateEstimator
from .stride_learning import StrideLearning
from .zmp_feedback import ZmpFeedback

Vector = tuple[float, float]
ZERO = (0.0, 0.0)


class StabiliserTargets(NamedTuple):
    """Commanded motion of the body at one tick, in odometry.

    Attributes:
        body: CoM and feet.
        dcm: DCM, in [m].
        acceleration: Acceleration of the CoM, in [m/s^2].
        reaction: Shift of the ZMP by the swing leg, in [m].
    """

    body: BodyReference
    dcm: Vector
    acceleration: Vector
    reaction: Vector


class Stabiliser:
    """Feedback controller of one walking robot.

    Attributes:
        settings: Method and gains.
        estimator: State estimator.
        state: Last estimate; None before the first.
        error: DCM less its command, beyond the dead zone, in [m].
        com_error: Likewise for the CoM.
        com_shift: CoM reference less the plan's, in [m].
        dcm_shift: Likewise for the DCM.
        zmp_shift: Likewise for the ZMP.
        step_shift: Landing of the swing foot less the plan's, in [m].
        adapted: Number of footsteps that were moved.
        joints: Correction of joint errors.
        zmp_feedback: Rule for the ZMP shift.
        stride: Learning of the footsteps' shortfall.
        tick: Control period, in [s].
        lean: See :meth:`BodyReference.roll`, in [rad].
    """

    def __init__(
        self,
        settings: ControlSettings,
        estimator: StateEstimator,
        gait: GaitSettings,
        *,
        tick: float,
        delay: float = 0.0,
        lean: float = 0.0,
    ) -> None:
        """Prepare the stabiliser.

        ``delay`` is the time from a command to the motion, in [s].
        """
        self.settings, self.estimator = settings, estimator
        self.state: BodyState | None = None
        self.error: Vector = ZERO
        self.com_error: Vector = ZERO
        self.com_shift: Vector = ZERO
        self.dcm_shift: Vector = ZERO
        self.zmp_shift: Vector = ZERO
        self.step_shift: Vector = ZERO
        self.adapted = 0
        gains = settings.stabiliser
        self.joints = JointCorrection(
            gains.joint_gain,
            gains.joint_bound,
            gains.joint_leak,
            tick=tick,
            delay=delay,
        )
        self.zmp_feedback = ZmpFeedback(settings, gait, tick)
        self.stride = StrideLearning(
            gait, gains.stride_gain, gains.stride_bound
        )
        self._gait, self.tick, self.lean = gait, tick, lean
        self._grow = exp(gait.eta * tick)
        self._boxes = {foot: zmp_box(foot, gait, gains.edge) for foot in Foot}
        self._ankles = Ankles(gains, tick)
        self._asked: deque[StabiliserTargets] = deque(
            maxlen=max(1, round(delay / tick) + 1)
        )

    @property
    def delay_ticks(self) -> int:
        """Delay from a command to the motion, in ticks."""
        return (self._asked.maxlen or 1) - 1

    @property
    def ready(self) -> bool:
        """Whether the robot has stood still long enough to start walking."""
        return self.estimator.ready

    def update(
        self, measurement: RobotState, row: ReferenceSample, step: CurrentStep
    ) -> BodyReference:
        """Run one control tick; return the commanded body."""
        self._observe(measurement, row, step)
        if not self.ready:
            return row.body
        self._react(step)
        body = shifted_swing(row.body, step, self.step_shift)
        body = self.stride.aimed(body, step)
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
        self.state = state
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
        px, py = self.zmp_feedback.shift(step, (dx, dy), self.zmp_shift)
        dx = px + self._grow * (dx - px)
        dy = py + self._grow * (dy - py)
        self.zmp_shift = px, py
        self.dcm_shift = dx, dy
        self.com_shift = (
            cx + tick * eta * (dx - cx),
            cy + tick * eta * (dy - cy),
        )
        if step.walking and step.remaining > 0.0:
            if step.progress < gains.freeze:
                rest = 1.0 - rate
                ex, ey = dx + rest * self.error[0], dy + rest * self.error[1]
                self._adapt(step.to_support(ex, ey), step)

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
        """Add the shifts to the planned state when a step ends.

        It is the landed foot in odometry, and CoM and its velocity in the
        frame of that foot, in [m] and [m/s].
        """
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
        elif self.estimator.posture is not None:
            self.stride.learn(self.estimator.posture, step)
        self.com_shift = self.dcm_shift = self.step_shift = ZERO
        return (
            Pose(landed.x + u, landed.y + v, landed.theta),
            (position[0] + x, position[1] + y),
            (velocity[0] + vx, velocity[1] + vy),
        )

    def fit(
        self,
        plan_from: Callable[[CenterState], ManeuverPlan],
        state: CenterState,
        support: Pose,
    ) -> tuple[ManeuverPlan, CenterState]:
        """Plan with the correction inside the sole.

        The remaining DCM error becomes a shift. ``support`` is the support
        foot in odometry, in whose frame the state is.
        """
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
