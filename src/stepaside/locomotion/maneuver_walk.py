"""Locomotion of the paper: a maneuver is planned for every step."""

from collections.abc import Iterator
from math import pi
from time import process_time
from typing import TYPE_CHECKING

from ..core.poses import Array, Pose
from ..perception.measurement import RobotState
from ..planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)
from ..planning.maneuver import landing_state
from ..planning.schedule import swing_progress
from ..robots.leg_kinematics import BodyReference, LegKinematics
from ..strategies.velocity_set import VelocitySet
from .locomotion import (
    CurrentStep,
    GuardDecision,
    IntentSource,
    MotionRequest,
    Phase,
    StepStarted,
    resting_step,
)
from .zmp.open_loop import OpenLoop
from .zmp.reference_table import ReferenceTable, resting_sample

if TYPE_CHECKING:
    from .guard import Guard

SETTLING = 1.0  # how long a halted robot takes to come to rest, in [s]
RETRY_PERIOD = 0.2  # between attempts of a blocked robot, in [s]


class ManeuverWalk:
    """Walk by maneuvers (Sec. III), planned at the end of each step.

    All poses are in the own odometry: the frame midway between the feet at the
    start.
    """

    def __init__(
        self,
        gait: GaitSettings,
        kinematics: LegKinematics,
        balance: OpenLoop | None = None,
        *,
        tick: float,
        delay: float = 0.0,
        first_foot: Foot = Foot.LEFT,
        guard: "Guard | None" = None,
    ) -> None:
        self.gait = gait
        self.kinematics = kinematics
        self.balance = OpenLoop(kinematics) if balance is None else balance
        self.phase = Phase.STANDING
        self.plan: ManeuverPlan | None = None
        self.plan_frame = Pose(0.0, 0.0, 0.0)
        self.plan_started = self._blocked_until = self._plan_ends = 0.0  # [s]
        half = 0.5 * gait.foot_spacing
        self.left_foot = Pose(0.0, half, 0.0)
        self.right_foot = Pose(0.0, -half, 0.0)
        self.begun: StepStarted | None = None
        self.pose_delay = delay + tick  # [s]
        self._delay = delay
        self.planner, self.guard = ManeuverPlanner(gait), guard
        self._relaxed = False
        self._first_foot = first_foot
        self._index = 0
        self._landing: Pose | None = None
        self._table = ReferenceTable(tick)
        self._stand()
        self.joint_targets: Array = kinematics.stand(self.reference)

    @property
    def velocities(self) -> VelocitySet:
        """Velocities of the gait."""
        speed, turn = velocity_limits(self.gait)
        return VelocitySet((-speed, speed), (0.0, 0.0), (-turn, turn))

    @property
    def torso_heading(self) -> float:
        """Heading of the torso, as measured if feedback does so, in [rad]."""
        measured = self.balance.measured_heading
        return self.balance.planned_heading if measured is None else measured

    @property
    def heading_delay(self) -> float:
        """Time until the torso has that heading, in [s]."""
        return self._delay if self.balance.measured_heading is None else 0.0

    @property
    def pose(self) -> Pose:
        """Pose of the template unicycle, in odometry."""
        return self._table.template(self._index)

    @property
    def reference(self) -> BodyReference:
        """Body reference of the last tick, in odometry."""
        return self.balance.commanded or self._table.sample(self._index).body

    @property
    def planned_centers(self) -> tuple[float, float, float, float]:
        """CoM reference (x, y), then ZMP reference, in odometry, in [m]."""
        x, y, u, v = self._table.centers(self._index)
        if self.balance.commanded is not None:
            x, y, _ = self.balance.commanded.com
        return x, y, u, v

    @property
    def tilt(self) -> tuple[float, float] | None:
        """Roll and pitch of the torso, in [rad]; None without an estimate."""
        return self.balance.tilt

    @property
    def maneuvers(self) -> "ManeuverWalk":
        """Itself: a walk by maneuvers."""
        return self

    @property
    def feels(self) -> bool:
        """Whether balance uses joint angles, IMU or forces on the soles."""
        return self.balance.feels

    def decides(self, now: float) -> bool:
        """Return whether a decision is due at a tick, at a time in [s]."""
        if self.plan is None:
            return now >= self._blocked_until
        return now >= self._plan_ends - 1e-9

    def next_step(self, now: float) -> tuple[float, Pose, Foot] | None:
        """Return time [s] and support of a step to decide on, if any is."""
        if self.phase in (Phase.HALTING, Phase.FALLEN):
            return None
        if not (self.decides(now) and (self.plan or self.balance.ready)):
            return None
        step = self.step(now)
        # A step ends before the tick.
        begins = self._plan_ends if self.plan else now
        return begins, step.landing, step.swing

    def coast(self, now: float) -> Array | None:
        """Run a control tick that needs neither measurement nor decision.

        Joint targets, in [rad]; None if it needs one, and nothing has changed.
        """
        if self.decides(now) or self.guard is not None:
            return None
        index = self._table.index(now)
        targets = self.balance.planned_targets(self._table, index)
        if targets is None:
            return None
        self.begun, self._index, self.joint_targets = None, index, targets
        return targets

    def note(self, measurement: RobotState) -> None:
        """Update the known obstacles, before a decision."""
        if self.guard is not None:
            body = self.reference
            planned = Pose(*body.com[:2], body.heading)
            self.guard.note(measurement, planned)

    def update(
        self, measurement: RobotState, decisions: IntentSource
    ) -> Array:
        """Return the joint targets of a tick, in [rad]; decide if due."""
        self.begun = None
        if self.phase is Phase.FALLEN:
            return self.joint_targets
        now = measurement.time
        if self.plan is None:
            self._wait(now, decisions)
        elif self.decides(now):
            self._finish(self.plan, decisions)
        table = self._table
        self._index = index = table.index(now)
        targets = self.balance.targets(measurement, table, index, self.step)
        if targets is None:
            self.phase, self.plan = Phase.FALLEN, None
            return self.joint_targets
        self.joint_targets = targets
        return targets

    def _stand(self) -> None:
        """Come to rest midway between the feet."""
        self.phase, self.plan = Phase.STANDING, None
        self._table.rest(
            resting_sample(self.left_foot, self.right_foot, self.gait)
        )

    def _wait(self, now: float, decisions: IntentSource) -> None:
        """Stand until the player requests motion."""
        if not (self.balance.ready and self.decides(now)):
            return
        if not decisions.starts(now):
            return
        x, y, _ = self.reference.com
        for _ in self._start_attempts():
            support = self._support(self._first_foot)
            rest = support.inverse().compose(Pose(x, y, 0.0))
            state = CenterState(rest[:2], (0.0, 0.0))
            self._replan(now, support, state, decisions, standing=True)
            if self.plan is not None or not self._blocked_until > now:
                return
            # Starting with the other foot sways to the other side first.
            self._first_foot = self._first_foot.other

    def _finish(self, plan: ManeuverPlan, decisions: IntentSource) -> None:
        """End a step: the landed foot becomes the support, then replan."""
        landed = self.plan_frame.compose(plan.landing)
        position, velocity = landing_state(plan)
        landed, position, velocity = self.balance.land(
            landed, position, velocity, self.step(self._plan_ends)
        )
        state = CenterState(position, velocity)
        if plan.first_foot is Foot.LEFT:
            self.left_foot = landed
        else:
            self.right_foot = landed
        if self.phase is Phase.HALTING:
            self._stand()
            return
        self._first_foot = plan.first_foot.other
        self._replan(self._plan_ends, landed, state, decisions, standing=False)

    def _replan(
        self,
        started: float,
        support: Pose,
        state: CenterState,
        decisions: IntentSource,
        *,
        standing: bool,
    ) -> None:
        """Plan the decided maneuver, or come to rest (Sec. III-E)."""
        clock, foot = process_time(), self._first_foot
        request = decisions.decide(
            started, support, foot.other, moving=not standing
        )
        if request is None:
            self._halt(started, support, state)
            return
        feet = support, self._support(foot.other)
        selected = None
        if request.intent.walks:
            selected = self._allowed(
                request, state, feet, foot, standing=standing
            )
        if selected is None:
            self._blocked_until = (
                started + RETRY_PERIOD if request.intent.walks else 0.0
            )
            if not standing:
                self._halt(started, support, state)
            return
        plan, state = selected
        spent = process_time() - clock
        self.phase = Phase.WALKING
        duration = plan.schedule.first_step_duration
        self._walk(plan, support, started, duration, state, spent)

    def _start_attempts(self) -> Iterator[None]:
        """Yield the start attempts of a standing robot: once with each foot.

        Then again with relaxed clearance, if the map may be off.
        """
        blurred = self.guard is not None and self.guard.map_error > 0.0
        try:
            for self._relaxed in (False, True)[: 1 + blurred]:
                for _ in Foot:
                    yield
        finally:
            self._relaxed = False

    def _allowed(
        self,
        request: MotionRequest,
        state: CenterState,
        feet: tuple[Pose, Pose],
        foot: Foot,
        *,
        standing: bool,
    ) -> tuple[ManeuverPlan, CenterState] | None:
        """Plan an intent, or the accepted decision closest to it.

        The state is in the frame of the support foot, the first of the feet in
        odometry. None to stand.
        """
        support = feet[0]
        swing_start = support.inverse().compose(feet[1])

        def plan_of(choice: GuardDecision, state: CenterState) -> ManeuverPlan:
            direction, chosen = request.direction, choice.intent
            if choice.back:
                direction = Direction(-direction.value)
            plan = self.planner.plan(
                chosen.heading,
                direction,
                first_foot=foot,
                state=state,
                swing_start=swing_start,
                standing=standing,
                drive=TemplateDrive(request.saturated, chosen.speed_factor),
            )
            if self.guard is None:
                return plan
            return self.guard.adjust_footsteps(plan, support)

        intent = request.intent
        accepted: GuardDecision | None = GuardDecision(intent)
        if self.guard is not None:
            # The fit to the state moves no foot: it can follow the choice.
            def planned(choice: GuardDecision) -> ManeuverPlan:
                return plan_of(choice, state)

            if self._relaxed:
                accepted = self.guard.choose_escape(intent, planned, support)
            else:
                accepted = self.guard.choose(
                    intent, planned, support, standing=standing
                )
        if accepted is None:
            return None
        walked = accepted
        if standing:
            return plan_of(walked, state), state
        return self.balance.fit(
            lambda state: plan_of(walked, state), state, support
        )

    def _halt(self, started: float, support: Pose, state: CenterState) -> None:
        """Plan the halt that brings the feet abreast."""
        foot = self._first_foot
        plan = self.planner.plan_halt(
            first_foot=foot,
            state=state,
            swing_start=support.inverse().compose(self._support(foot.other)),
        )
        self.phase = Phase.HALTING
        duration = plan.schedule.duration + SETTLING
        self._walk(plan, support, started, duration, state, None)

    def _walk(
        self,
        plan: ManeuverPlan,
        frame: Pose,
        started: float,
        duration: float,
        state: CenterState,
        spent: float | None,
    ) -> None:
        self.plan, self.plan_frame, self.plan_started = plan, frame, started
        self._plan_ends = started + duration
        self._table.load(plan, frame, started, duration)
        landing = plan.schedule.first_step_duration
        landing += started - plan.gait.double_support
        self._landing = landed = frame.compose(plan.landing)
        vx, vy = plan.start_velocity.tolist()
        jump = max(abs(vx - state.velocity[0]), abs(vy - state.velocity[1]))
        self.begun = StepStarted(
            plan, started, landing, plan.first_foot, landed, spent, jump
        )

    def step(self, now: float) -> CurrentStep:
        """Return the step in progress at a time, in [s]."""
        if self.plan is None:
            foot = self._first_foot
            return resting_step(self._support(foot), foot)
        return first_step_of(
            self.plan,
            self.plan_frame,
            now - self.plan_started,
            self._landing,
        )

    def _support(self, swing: Foot) -> Pose:
        """Return the support foot while the other swings, in odometry."""
        return self.right_foot if swing is Foot.LEFT else self.left_foot


def first_step_of(
    plan: ManeuverPlan,
    frame: Pose,
    passed: float,
    landing: Pose | None = None,
) -> CurrentStep:
    """Return the first step of a plan with a frame in odometry.

    The planned landing is given if it is known.
    """
    gait = plan.schedule.settings
    walked = passed
    if plan.schedule.standing:
        walked -= gait.start_support
    return CurrentStep(
        frame,
        plan.first_foot,
        frame.compose(plan.landing) if landing is None else landing,
        gait.single_support - walked,
        swing_progress(walked / gait.single_support, gait.swing_profile),
        True,
        plan,
        passed,
    )


def velocity_limits(gait: GaitSettings) -> tuple[float, float]:
    """Return the greatest speed [m/s] and turning rate [rad/s] of a gait.

    A stride takes a whole step, longer than the path time of the template.
    """
    pace = gait.path_interval / gait.step_duration
    return gait.speed * pace, gait.gain * pace * pi
