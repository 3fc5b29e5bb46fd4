"""The control scheme of one robot (paper, Fig. 4)."""

from time import process_time

from ..core.poses import Array, Pose
from ..locomotion.zmp.current_step import CurrentStep, resting_step, step_of
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
PATIENCE = 0.2  # until one that cannot move asks again, in [s]


class ControlScheme:
    """Perceives the other, plans at the end of each double support, moves.

    Everything is kept in the robot's own odometry: the frame that lay
    midway between its feet when it began. What has been is not kept: who
    wants to know looks after each tick at the step that it began.

    Attributes:
        decisions: Its strategy, and what that remembers.
        settings: Gait.
        kinematics: Joint motion generation.
        balance: What keeps the robot up.
        senses: How it learns where the other is.
        phase: What the robot is doing.
        sighting: The other, as it was seen last; None if it is lost.
        plan: Maneuver being walked; None while standing.
        plan_frame: Pose of its frame in odometry.
        plan_started: When it began, in [s].
        reference: What the body is asked for at this tick, in odometry.
        zmp_reference: ZMP reference at this tick in odometry, in [m].
        left_foot: Pose of the left foot when it last stood, in odometry.
        right_foot: Pose of the right foot, likewise.
        begun: Step that began at this tick; None if none did.
        joint_targets: Of this tick, in [rad]. Shape (joints,).
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
            strategy: From what it knows to what it wants.
            settings: Gait.
            kinematics: The robot's joint motion generation.
            tick: Control period, in [s].
            delay: Time from a request to the motion, in [s].
            first_foot: Foot that makes the first step.
            balance: What keeps the robot up; the plan alone by default.
            senses: How it learns where the other is; by the sightings that
                measurements bring by default.
            guard: What keeps it clear of what stands around; nothing by
                default.

        Raises:
            ReachError: If the robot cannot stand as the gait asks.
        """
        around = None if guard is None else guard.surroundings
        self.decisions = StrategyRunner(strategy, settings, tick, around)
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
        self._delay, self._late = delay, delay + tick
        self._maneuvers = ManeuverSelection(settings, self.balance, guard)
        self._first_foot = first_foot
        self._table = ReferenceTable(tick)
        self._stand()
        self.decisions.templates.note(0.0, self._resting.template)
        self.joint_targets: Array = kinematics.stand(self.reference)

    def update(self, measurement: Measurement) -> Array:
        """Run one control tick.

        Args:
            measurement: What the sensors give.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs lose the reference.
            StrategyError: If the strategy gives no intent.
        """
        self.begun = None
        if self.phase is Phase.FALLEN:
            return self.joint_targets
        now, balance = measurement.time, self.balance
        measured = balance.torso_heading
        known = self.kinematics.torso_heading if measured is None else measured
        self.decisions.feel(measurement, stands=self.plan is None)
        late = self._delay if measured is None else 0.0
        self.decisions.headings.note(now + late, known)
        self.sighting = self.senses.see(measurement, self.step, balance.tilt)
        if self._maneuvers.guard is not None:
            around = self._maneuvers.guard.surroundings
            around.note(measurement, self.reference)
        if self.plan is None:
            self._wait(now)
        elif now >= self._plan_ends - 1e-9:
            self._finish(self.plan)
        sample = self._resting if self.plan is None else self._table.at(now)
        self.decisions.templates.note(now + self._late, sample.template)
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
        """What the robot plans and asks of its body now."""
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
        """Make the next first step with a foot, if the robot stands."""
        if self.plan is None:
            self._first_foot = foot

    def _stand(self) -> None:
        """Rest midway between the feet."""
        self.phase, self.plan = Phase.STANDING, None
        self._resting = resting_sample(
            self.left_foot, self.right_foot, self.settings
        )
        self.reference, self.zmp_reference, *_ = self._resting

    def _wait(self, now: float) -> None:
        """Stand until the other is a reason to move."""
        seen = self.sighting
        if not self.balance.ready or now < self._blocked_until:
            return
        if not self.decisions.starts(now, seen, self.senses.turning):
            return
        x, y, _ = self.reference.com
        for _ in self._maneuvers.tries():
            support = self._support(self._first_foot)
            rest = support.inverse().compose(Pose(x, y, 0.0))
            state = CenterState(rest[:2], (0.0, 0.0))
            self._replan(now, support, state, seen, standing=True)
            if self.plan is not None or not self._blocked_until > now:
                return
            # Who sways to the other side first may have more room there.
            self._first_foot = self._first_foot.other

    def _finish(self, plan: ManeuverPlan) -> None:
        """End a step: the foot that landed supports, and a plan follows."""
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
        seen: Sighting | None,
        *,
        standing: bool,
    ) -> None:
        """Plan from what was seen last, or come to rest (Sec. III-E)."""
        clock, who = process_time(), self.decisions.strategy
        foot, turning = self._first_foot, self.senses.turning
        intent = self.decisions.decide(
            started, seen, turning, (support, foot.other), moving=not standing
        )
        feet = support, self._support(foot.other)
        planned = None
        if intent.walks:
            planned = self._maneuvers.plan(
                intent, who, state, feet, foot, standing=standing
            )
        if planned is None:
            self._blocked_until = started + PATIENCE if intent.walks else 0.0
            if not standing:
                self._halt(started, support, state)
            return
        plan, state = planned
        spent = process_time() - clock
        self.phase = Phase.WALKING
        duration = plan.schedule.first_step_duration
        self._walk(plan, support, started, duration, state, spent)

    def _halt(self, started: float, support: Pose, state: CenterState) -> None:
        """Bring the feet abreast and come to rest."""
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
        """Replace the plan that is walked."""
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
        """Step being made at a time, in [s]."""
        if self.plan is None:
            foot = self._first_foot
            return resting_step(self._support(foot), foot)
        return step_of(self.plan, self.plan_frame, now - self.plan_started)

    def _support(self, swing: Foot) -> Pose:
        """Foot that stands while another swings, in odometry."""
        return self.right_foot if swing is Foot.LEFT else self.left_foot
