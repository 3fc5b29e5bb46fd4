"""The control scheme of one robot (paper, Fig. 4)."""

from time import process_time

from ..core.poses import Array, Pose
from ..locomotion.zmp.current_step import (
    CurrentStep,
    first_step_of,
    resting_step,
)
from ..locomotion.zmp.feedback_loop import Balance, OpenLoop
from ..locomotion.zmp.reference_table import (
    ReferenceSample,
    ReferenceTable,
    resting_sample,
)
from ..perception.measurement import Measurement, Sighting
from ..planning import CenterState, Foot, GaitSettings, ManeuverPlan
from ..planning.steady_gait import landing_state
from ..robots.leg_kinematics import BodyReference, LegKinematics
from ..strategies.strategy import Strategy
from .clearance.guard import Guard
from .maneuver_selection import ManeuverSelection
from .phase import Phase
from .sight_sources import MeasuredSight, SightSource
from .strategy_runner import StrategyRunner
from .walk_snapshots import StepStarted, WalkState

SETTLING = 1.0  # how long a halted robot takes to come to rest, in [s]
RETRY_PERIOD = 0.2  # between attempts of a blocked robot, in [s]


class ControlScheme:
    """Control of one robot: sense, plan at the end of each step, move.

    All poses are in the robot's own odometry: the frame midway between its
    feet at the start. No history is stored: a recorder reads ``begun`` after
    each tick.

    Attributes:
        decisions: Strategy with its memory.
        settings: Gait.
        kinematics: Joint motion generation.
        balance: Balance control.
        senses: Source of sightings of the opponent.
        phase: Phase of motion.
        sighting: Last sighting of the opponent; None if it is lost.
        plan: Maneuver being walked; None while standing.
        plan_frame: Pose of its frame in odometry.
        plan_started: When it began, in [s].
        reference: Body reference of this tick, in odometry.
        zmp_reference: ZMP reference at this tick in odometry, in [m].
        left_foot: Last stance pose of the left foot, in odometry.
        right_foot: Last stance pose of the right foot, likewise.
        begun: Step that began at this tick; None if none did.
        joint_targets: Joint targets of this tick, in [rad]. Shape (joints,).
    """

    def __init__(
        self,
        strategy: Strategy,
        settings: GaitSettings,
        kinematics: LegKinematics,
        *,
        tick: float,
        delay: float = 0.0,
        first_foot: Foot = Foot.LEFT,
        balance: Balance | None = None,
        senses: SightSource | None = None,
        guard: Guard | None = None,
    ) -> None:
        """Take the standing posture.

        Args:
            strategy: Strategy of the player.
            settings: Gait.
            kinematics: Joint motion generation of the robot.
            tick: Control period, in [s].
            delay: Time from a request to the motion, in [s].
            first_foot: Foot that makes the first step.
            balance: Balance control; none by default, the plan alone.
            senses: Source of sightings; by default those that
                measurements bring.
            guard: Guard against obstacles; none by default.
            guard: What keeps it clear of what stands around; nothing by
                default.

        Raises:
            ReachError: If the standing posture of the gait is out of reach.
        """
        surroundings = None if guard is None else guard.surroundings
        self.decisions = StrategyRunner(strategy, settings, tick, surroundings)
        self.settings = settings
        self.kinematics = kinematics
        self.balance: Balance = OpenLoop() if balance is None else balance
        self.senses: SightSource = (
            MeasuredSight() if senses is None else senses
        )
        self.sighting: Sighting | None = None
        self.phase = Phase.STANDING
        self.reference: BodyReference
        self._resting: ReferenceSample
        self.plan: ManeuverPlan | None = None
        self.plan_frame = Pose(0.0, 0.0, 0.0)
        self.plan_started = self._blocked_until = self._plan_ends = 0.0
        half = 0.5 * settings.foot_spacing
        self.left_foot = Pose(0.0, half, 0.0)
        self.right_foot = Pose(0.0, -half, 0.0)
        self.begun: StepStarted | None = None
        self._delay, self._latency = delay, delay + tick
        self._maneuvers = ManeuverSelection(settings, self.balance, guard)
        self._first_foot = first_foot
        self._table = ReferenceTable(tick)
        self._stand()
        self.decisions.templates.note(0.0, self._resting.template)
        self.joint_targets: Array = kinematics.stand(self.reference)

    def update(self, measurement: Measurement) -> Array:
        """Run one control tick.

        Args:
            measurement: Measurement of the tick.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs cannot follow the reference.
            StrategyError: If the strategy returns no intent.
        """
        self.begun = None
        if self.phase is Phase.FALLEN:
            return self.joint_targets
        now, balance = measurement.time, self.balance
        measured = balance.torso_heading
        heading = (
            self.kinematics.torso_heading if measured is None else measured
        )
        self.decisions.calibrate(measurement, stands=self.plan is None)
        delay = self._delay if measured is None else 0.0
        self.decisions.headings.note(now + delay, heading)
        self.sighting = self.senses.see(measurement, self.step, balance.tilt)
        if self._maneuvers.guard is not None:
            surroundings = self._maneuvers.guard.surroundings
            surroundings.note(measurement, self.reference)
        if self.plan is None:
            self._wait(now)
        elif now >= self._plan_ends - 1e-9:
            self._finish(self.plan)
        sample = self._resting if self.plan is None else self._table.at(now)
        self.decisions.templates.note(now + self._latency, sample.template)
        self.zmp_reference = sample.zmp
        self.reference = balance.update(measurement, sample, self.step)
        if balance.has_fallen:
            self.phase, self.plan = Phase.FALLEN, None
            return self.joint_targets
        targets = self.kinematics.track(self.reference)
        targets = balance.correct(measurement, targets)
        self.senses.aim(targets)
        self.joint_targets = targets
        return targets

    @property
    def state(self) -> WalkState:
        """Plan and references of the current tick."""
        return WalkState(
            phase=self.phase,
            gait=self.settings,
            plan=self.plan,
            plan_frame=self.plan_frame,
            plan_started=self.plan_started,
            left_foot=self.left_foot,
            right_foot=self.right_foot,
            first_foot=self._first_foot,
            reference=self.reference,
            zmp_reference=self.zmp_reference,
            sighting=self.sighting,
            torso_heading=self.kinematics.torso_heading,
            estimate=self.balance.state,
            solved=self.balance.solved,
            adapted=self.balance.adapted,
        )

    def lead_with(self, foot: Foot) -> None:
        """Choose the foot of the first step, if the robot stands."""
        if self.plan is None:
            self._first_foot = foot

    def _stand(self) -> None:
        """Come to rest midway between the feet."""
        self.phase, self.plan = Phase.STANDING, None
        self._resting = resting_sample(
            self.left_foot, self.right_foot, self.settings
        )
        self.reference, self.zmp_reference, *_ = self._resting

    def _wait(self, now: float) -> None:
        """Stand until the strategy requests motion."""
        sighting = self.sighting
        if not self.balance.ready or now < self._blocked_until:
            return
        if not self.decisions.starts(now, sighting, self.senses.turning):
            return
        x, y, _ = self.reference.com
        for _ in self._maneuvers.start_attempts():
            support = self._support(self._first_foot)
            rest = support.inverse().compose(Pose(x, y, 0.0))
            state = CenterState(rest[:2], (0.0, 0.0))
            self._replan(now, support, state, sighting, standing=True)
            if self.plan is not None or not self._blocked_until > now:
                return
            # Starting with the other foot sways to the other side first.
            self._first_foot = self._first_foot.other

    def _finish(self, plan: ManeuverPlan) -> None:
        """End a step: the landed foot becomes the support, then replan."""
        landed = self.plan_frame.compose(Pose(*plan.placements[2].tolist()))
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
        ended = self.plan_started + plan.schedule.first_step_duration
        if self.sighting is None and not self.senses.turning:
            self._halt(ended, landed, state)
        else:
            self._replan(ended, landed, state, self.sighting, standing=False)

    def _replan(
        self,
        started: float,
        support: Pose,
        state: CenterState,
        sighting: Sighting | None,
        *,
        standing: bool,
    ) -> None:
        """Plan from the last sighting, or come to rest (Sec. III-E)."""
        clock, strategy = process_time(), self.decisions.strategy
        foot, turning = self._first_foot, self.senses.turning
        intent = self.decisions.decide(
            started,
            sighting,
            turning,
            (support, foot.other),
            moving=not standing,
        )
        feet = support, self._support(foot.other)
        selected = None
        if intent.walks:
            selected = self._maneuvers.plan(
                intent, strategy, state, feet, foot, standing=standing
            )
        if selected is None:
            self._blocked_until = (
                started + RETRY_PERIOD if intent.walks else 0.0
            )
            if not standing:
                self._halt(started, support, state)
            return
        plan, state = selected
        spent = process_time() - clock
        self.phase = Phase.WALKING
        duration = plan.schedule.first_step_duration
        self._walk(plan, support, started, duration, state, spent)

    def _halt(self, started: float, support: Pose, state: CenterState) -> None:
        """Plan the halt that brings the feet abreast."""
        foot = self._first_foot
        plan = self._maneuvers.planner.plan_halt(
            first_foot=foot,
            state=state,
            swing_start=support.inverse().compose(self._support(foot.other)),
            pace=self.decisions.pace,
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
        """Replace the current plan."""
        self.plan, self.plan_frame, self.plan_started = plan, frame, started
        self._plan_ends = started + duration
        self._table.load(plan, frame, started, duration)
        landing = plan.schedule.first_step_duration
        landing += started - plan.gait.double_support
        landed = frame.compose(Pose(*plan.placements[2].tolist()))
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
            self.plan, self.plan_frame, now - self.plan_started
        )

    def _support(self, swing: Foot) -> Pose:
        """Return the support foot while the other swings, in odometry."""
        return self.right_foot if swing is Foot.LEFT else self.left_foot
