r"""Feedback on top of a plan: ZMP, ankles and the next footstep.

The joints are stiff, so small errors are theirs. Beyond a dead zone the
reference gives way: it carries a shift of CoM and DCM from the plan that
grows towards the measured error and that a shift of the ZMP, as far as the
sole allows, brings back. The linear inverted pendulum moves both,

.. math:: \dot{\delta\xi} = \eta (\delta\xi - \delta p), \qquad
   \dot{\delta x} = \eta (\delta\xi - \delta x).

What the sole cannot hold, the next footstep takes up. At the end of the step
the next plan begins at the shifted state; with the measured method, at the
measured one, as far as the correction of that plan stays in the sole.
"""

from collections import deque
from collections.abc import Callable
from math import exp, hypot
from typing import NamedTuple

from ...core.poses import Pose
from ...perception.measurement import Measurement
from ...planning import CenterState, GaitSettings, ManeuverPlan
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
from .zmp_feedback import zmp_feedback

Vector = tuple[float, float]
ZERO = (0.0, 0.0)


class StabiliserTargets(NamedTuple):
    """What was asked of the body at one tick, in odometry.

    Attributes:
        body: CoM and feet.
        dcm: DCM, in [m].
        acceleration: Of the CoM, in [m/s^2].
        reaction: Shift of the ZMP by the swing leg, in [m].
    """

    body: BodyReference
    dcm: Vector
    acceleration: Vector
    reaction: Vector


class Stabiliser:
    """Feedback of one robot.

    Attributes:
        settings: Method and gains.
        estimator: State from sensors.
        state: Last estimate; None before the first.
        error: DCM less what was asked of it, beyond the dead zone, in [m].
        com_error: Likewise for the CoM.
        com_shift: CoM reference less the plan's, in [m].
        dcm_shift: Likewise for the DCM.
        zmp_shift: Likewise for the ZMP.
        step_shift: Landing of the swing foot less the plan's, in [m].
        adapted: Number of footsteps that were moved.
        joints: Correction of the joint targets.
        zmp_feedback: How the ZMP brings the shifts back.
        stride: What the feet fall short by.
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
        """Prepare feedback.

        Args:
            settings: Method and gains.
            estimator: State from sensors.
            gait: Gait.
            tick: Control period, in [s].
            delay: Time from a request to the motion, in [s].
            lean: See :meth:`BodyReference.roll`, in [rad].
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
        self.zmp_feedback = zmp_feedback(settings, gait, tick)
        self.stride = StrideLearning(
            gait, gains.stride_gain, gains.stride_bound
        )
        self._gait, self._tick, self._lean = gait, tick, lean
        self._grow = exp(gait.eta * tick)
        self._ankles = Ankles(gains, tick)
        self._asked: deque[StabiliserTargets] = deque(
            maxlen=max(1, round(delay / tick) + 1)
        )

    @property
    def ready(self) -> bool:
        """Whether the robot may walk: it has stood still long enough."""
        return self.estimator.ready

    def update(
        self, measurement: Measurement, row: ReferenceSample, step: CurrentStep
    ) -> BodyReference:
        """Run one control tick.

        Args:
            measurement: What the sensors give.
            row: What the plan asks for.
            step: Step being made.

        Returns:
            What to ask of the body instead.
        """
        self._observe(measurement, row, step)
        if not self.ready:
            return row.body
        self._react(step)
        body = shifted_swing(row.body, step, self.step_shift)
        body = self.stride.aimed(body, step)
        x, y, z = row.body.com
        assert self.state is not None
        asked = self._asked[0].body
        left, right = self._ankles.tilts(self.state, asked.roll(self._lean))
        return body._replace(
            com=(x + self.com_shift[0], y + self.com_shift[1], z),
            left_tilt=left,
            right_tilt=right,
        )

    def _observe(
        self, measurement: Measurement, row: ReferenceSample, step: CurrentStep
    ) -> None:
        """Estimate the state and compare it with what was asked."""
        x, y, z = row.body.com
        x, y = x + self.com_shift[0], y + self.com_shift[1]
        square = self._gait.eta**2
        u, v = row.reaction
        self._asked.append(
            StabiliserTargets(
                shifted_swing(row.body, step, self.step_shift)._replace(
                    com=(x, y, z)
                ),
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
        asked = self._asked[0]
        state = self.estimator.update(
            measurement, asked.body, asked.acceleration, asked.reaction
        )
        self.state = state
        dead = self.settings.stabiliser.dead_zone
        self.error = beyond(
            state.dcm[0] - asked.dcm[0], state.dcm[1] - asked.dcm[1], dead
        )
        self.com_error = beyond(
            state.com[0] - asked.body.com[0],
            state.com[1] - asked.body.com[1],
            0.5 * dead,
        )

    def _react(self, step: CurrentStep) -> None:
        """Let the shifts give way, and bring them back."""
        gains, tick, eta = self.settings.stabiliser, self._tick, self._gait.eta
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
        """Move the landing, no faster than a swing foot can follow."""
        gains = self.settings.stabiliser
        box = zmp_box(step.swing, self._gait, gains.edge)
        goal = adapted_landing(error, step, box, self._gait, gains)
        reach = gains.step_speed * self._tick
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
        """Take the shifts over into the state that the next plan begins with.

        Args:
            landed: Foot that landed, as planned, in odometry.
            position: CoM as planned in its frame, in [m].
            velocity: Its velocity, in [m/s].
            step: Step that ends.

        Returns:
            The same, as it is to be believed now.
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
        """Plan so that the correction stays inside the sole.

        What the correction cannot take of the DCM stays a shift.

        Args:
            plan_from: Plans from a state of the CoM.
            state: Where to begin, in the frame of the support foot.
            support: That frame in odometry.
        """
        plan = plan_from(state)
        edge = self.settings.stabiliser.edge
        box = zmp_box(plan.first_foot, self._gait, edge)
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
