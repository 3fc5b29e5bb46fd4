"""The control scheme of one robot (paper, Fig. 4)."""

from time import process_time
from typing import TYPE_CHECKING

from ..planning import (
    CenterState,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from ..planning.steady import landing_state
from ..poses import Array, Pose, wrap_angle
from ..robots.kinematics import BodyReference, LegKinematics
from ..sensing.measurement import Measurement, Sighting
from ..strategies.roles import Role
from .balance.stabiliser import Stabiliser
from .balance.step import Step, resting_step, step_of
from .headings import HeadingMemory
from .phase import Phase
from .reference import ReferenceSample, ReferenceTable, standing_reference

if TYPE_CHECKING:
    from ..perception.perception import Perception

SETTLING = 1.0  # how long a halted robot takes to come to rest, in [s]


class ControlScheme:
    """Perceives the other, plans at the end of each double support, moves.

    Everything is kept in the robot's own odometry: the frame that lay
    midway between its feet when it began.

    Attributes:
        role: Pursuit or evasion.
        perception: What sees and moves the head, if there is any.
        phase: What the robot is doing.
        plan: Maneuver being walked; None while standing.
        plan_frame: Pose of its frame in odometry.
        plan_started: When it began, in [s].
        reference: What the body is asked for at this tick, in odometry.
        zmp_reference: ZMP reference at this tick in odometry, in [m].
        left_foot: Pose of the left foot when it last stood, in odometry.
        right_foot: Pose of the right foot, likewise.
        landings: Footsteps so far: (time of landing [s], foot, pose).
        replans: Number of maneuvers planned.
        planning_times: Processor time that each took, in [s].
        walked: Plans walked so far, for their margins afterwards.
        velocity_jumps: Jump of the CoM velocity reference at each plan, in
            [m/s].
    """

    def __init__(
        self,
        role: Role,
        settings: GaitSettings,
        kinematics: LegKinematics,
        *,
        tick: float,
        first_foot: Foot = Foot.LEFT,
        sighting: Sighting | None = None,
        stabiliser: Stabiliser | None = None,
        perception: "Perception | None" = None,
    ) -> None:
        """Take the standing posture.

        Args:
            role: Pursuit or evasion.
            settings: Gait.
            kinematics: The robot's joint motion generation.
            tick: Control period, in [s].
            first_foot: Foot that makes the first step.
            sighting: What is known of the other before anything is seen.
            stabiliser: Feedback on top of the plan; none by default.
            perception: What turns images into sightings; without it the
                measurements bring sightings.

        Raises:
            ReachError: If the robot cannot stand as the gait asks.
        """
        self.role = role
        self.settings = settings
        self.planner = ManeuverPlanner(settings)
        self.kinematics = kinematics
        self.phase = Phase.STANDING
        self.reference: BodyReference
        self._resting: ReferenceSample
        self.plan: ManeuverPlan | None = None
        self.plan_frame = Pose(0.0, 0.0, 0.0)
        self.plan_started = 0.0
        half = 0.5 * settings.foot_spacing
        self.left_foot = Pose(0.0, half, 0.0)
        self.right_foot = Pose(0.0, -half, 0.0)
        self.landings: list[tuple[float, Foot, Pose]] = []
        self.replans = 0
        self.planning_times: list[float] = []
        self.velocity_jumps: list[float] = []
        self.walked: list[ManeuverPlan] = []
        self.perception = perception
        self._first_foot = first_foot
        self._sighting = sighting
        self.stabiliser = stabiliser
        self._headings = HeadingMemory(tick)
        self._table = ReferenceTable(tick)
        self._plan_ends = 0.0
        self._stand()
        self.joint_targets: Array = kinematics.stand(self.reference)

    def update(self, measurement: Measurement) -> Array:
        """Run one control tick.

        Args:
            measurement: What the sensors give.

        Returns:
            Joint targets, in [rad]. Shape (joints,).

        Raises:
            ReachError: If the legs lose the reference.
        """
        if self.phase is Phase.FALLEN:
            return self.joint_targets
        now = measurement.time
        feedback = self.stabiliser
        known = feedback.estimator if feedback else self.kinematics
        self._headings.note(now, known.torso_heading)
        if self.perception is not None:
            foot = self.step(now)
            self._sighting = self.perception.see(
                measurement, foot.support, foot.swing is Foot.RIGHT
            )
        elif measurement.sighting is not None:
            self._sighting = measurement.sighting
        if self.plan is None:
            self._wait(now)
        elif now >= self._plan_ends - 1e-9:
            self._finish(self.plan)
        row = self._resting if self.plan is None else self._table.at(now)
        self.reference, self.zmp_reference = row.body, row.zmp
        if feedback is not None:
            step = self.step(now)
            self.reference = feedback.update(measurement, row, step)
            if feedback.state is not None and feedback.state.has_fallen:
                self.phase, self.plan = Phase.FALLEN, None
                return self.joint_targets
        targets = self.kinematics.track(self.reference)
        if feedback is not None:
            angles = measurement.joint_positions
            targets = feedback.joints.update(angles, targets)
        if self.perception is not None:
            self.perception.aim(targets)
        self.joint_targets = targets
        return targets

    @property
    def margins(self) -> list[float]:
        """ZMP margin of each plan in the part that was walked, in [m]."""
        return [
            plan.margin(plan.schedule.first_step_duration)
            for plan in self.walked
        ]

    def _stand(self) -> None:
        """Rest midway between the feet."""
        self.phase, self.plan = Phase.STANDING, None
        self.reference = standing_reference(
            self.left_foot, self.right_foot, self.settings
        )
        self.zmp_reference = rest = self.reference.com[:2]
        self._resting = ReferenceSample(self.reference, rest, rest)

    def _wait(self, now: float) -> None:
        """Stand until the other is a reason to move."""
        seen = self._sighting
        if self.stabiliser is not None and not self.stabiliser.ready:
            return
        if seen is None or not self.role.is_triggered(seen.distance):
            return
        support = self._support(self._first_foot)
        x, y, _ = self.reference.com
        rest = support.inverse().compose(Pose(x, y, 0.0))
        state = CenterState(rest[:2], (0.0, 0.0))
        self._replan(now, support, state, seen, standing=True)

    def _finish(self, plan: ManeuverPlan) -> None:
        """End a step: the foot that landed supports, and a plan follows."""
        step = Pose(*plan.placements[2].tolist())
        landed = self.plan_frame.compose(step)
        position, velocity = landing_state(plan)
        if self.stabiliser is not None:
            landed, position, velocity = self.stabiliser.land(
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
        seen = self._sighting
        if seen is not None and self.role.is_triggered(seen.distance):
            self._replan(ended, landed, state, seen, standing=False)
        else:
            self._halt(ended, landed, state)

    def _replan(
        self,
        started: float,
        support: Pose,
        state: CenterState,
        seen: Sighting,
        *,
        standing: bool,
    ) -> None:
        """Plan from what was seen last (Sec. III-E)."""
        clock = process_time()
        heading = self._headings.at(seen.time) + seen.bearing
        if self.stabiliser is not None:
            heading = self.stabiliser.prediction.ahead(seen.time, heading)
        heading -= support.theta
        aim = self.role.desired_heading(wrap_angle(heading))

        foot = self._first_foot
        swing_start = support.inverse().compose(self._support(foot.other))

        def plan_from(state: CenterState) -> ManeuverPlan:
            return self.planner.plan(
                aim,
                self.role.direction,
                first_foot=foot,
                state=state,
                swing_start=swing_start,
                standing=standing,
                saturated=self.role.saturated,
            )

        if self.stabiliser is None or standing:
            plan = plan_from(state)
        else:
            plan, state = self.stabiliser.fit(plan_from, state, support)
        self.planning_times.append(process_time() - clock)
        self.replans += 1
        self.phase = Phase.WALKING
        duration = plan.schedule.first_step_duration
        self._walk(plan, support, started, duration, state)

    def _halt(self, started: float, support: Pose, state: CenterState) -> None:
        """Bring the feet abreast and come to rest."""
        foot = self._first_foot
        plan = self.planner.plan_halt(
            first_foot=foot,
            state=state,
            swing_start=support.inverse().compose(self._support(foot.other)),
        )
        self.phase = Phase.HALTING
        duration = plan.schedule.duration + SETTLING
        self._walk(plan, support, started, duration, state)

    def _walk(
        self,
        plan: ManeuverPlan,
        frame: Pose,
        started: float,
        duration: float,
        state: CenterState,
    ) -> None:
        """Replace the plan that is walked."""
        self.plan, self.plan_frame, self.plan_started = plan, frame, started
        self._plan_ends = started + duration
        self._table.load(plan, frame, started, duration)
        landing = plan.schedule.first_step_duration
        landing += started - self.settings.double_support
        landed = frame.compose(Pose(*plan.placements[2].tolist()))
        self.landings.append((landing, plan.first_foot, landed))
        vx, vy = plan.start_velocity.tolist()
        jump = max(abs(vx - state.velocity[0]), abs(vy - state.velocity[1]))
        self.velocity_jumps.append(jump)
        self.walked.append(plan)

    def step(self, now: float) -> Step:
        """Step being made at a time, in [s]."""
        if self.plan is None:
            foot = self._first_foot
            return resting_step(self._support(foot), foot)
        passed = now - self.plan_started
        return step_of(self.plan, self.plan_frame, passed)

    def _support(self, swing: Foot) -> Pose:
        """Foot that stands while another swings, in odometry."""
        return self.right_foot if swing is Foot.LEFT else self.left_foot
