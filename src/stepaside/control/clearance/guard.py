"""Guard that admits only maneuvers after which the robot can stop clear.

A standing robot cannot hit a static obstacle. So a maneuver is executed only
if its first step *and* the halt after it keep clear of all known obstacles.
Otherwise the robot halts; that halt was checked when the previous step was
accepted. By induction, a robot that starts clear never touches a static
obstacle, whatever its strategy requests.

A map built from observations may be off by one cell. A robot that stands
within the margin of such a map would be stuck, since every step sways: if
no maneuver with either foot is accepted, it executes the one that leads out
of the margin with the least approach, at most one cell.
"""

from collections.abc import Iterator
from math import pi
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ...core.poses import Pose
from ...locomotion.maneuver_selection import GuardDecision, PlanFor
from ...perception.measurement import RobotState
from ...planning import ManeuverPlan, ManeuverPlanner
from ...planning.steady_gait import landing_state
from ...strategies.knowledge import Intent
from .footstep_adjustment import FootstepAdjustment
from .surroundings import Surroundings
from .swept_outline import BodyOutline

SPEED_SCALES = (1.0, 0.5, 0.05)  # tried in turn; the last only turns
SHARP = 2.0  # heading of a step back if no other is clear, in [rad]
NEARER = 1e-6  # approach tolerated inside the margin, in [m]
GAINED = 0.004  # clearance that an escape gains at least, in [m]


ESCAPES = tuple(
    GuardDecision(Intent(heading), back)
    for heading in (pi, -pi)
    for back in (False, True)
)


class ManeuverClearance(NamedTuple):
    """Clearance of the body over the first step of a maneuver and its halt."""

    now: float  # clearance at the start [m]
    least: float  # least clearance during the first step and the halt [m]
    last: float  # clearance after the halt [m]

    def escapes(
        self, margin: float, map_error: float, gained: float = NEARER
    ) -> bool:
        """Return whether the maneuver leads out of the margin.

        On the way the error of the map is tolerated as loss of clearance;
        ``gained`` is what is gained at least, unless it ends outside.
        """
        farther = self.last > min(self.now + gained, margin)
        near = self.least >= self.now - map_error - NEARER
        return self.now < margin and farther and near


class Guard:
    """Filter of intents that keeps a robot clear of known obstacles."""

    def __init__(
        self,
        surroundings: Surroundings,
        outline: BodyOutline,
        planner: ManeuverPlanner,
        *,
        margin: float,
        footholds: FootstepAdjustment | None = None,
    ) -> None:
        """Prepare the guard; with the MPC footsteps are adjusted."""
        self._footholds = footholds
        self.surroundings, self.margin = surroundings, margin
        self._outline, self._planner = outline, planner

    @property
    def map_error(self) -> float:
        """Largest position error of the obstacles, in [m]."""
        return self.surroundings.map_error

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Update the obstacles; see :meth:`.Surroundings.note`."""
        self.surroundings.note(measurement, pose)

    def choose(
        self,
        intent: Intent,
        plan_for: PlanFor,
        pose_plan_in_odometry: Pose,
        *,
        standing: bool,
    ) -> GuardDecision | None:
        """Return the accepted decision that is closest to an intent.

        It is the intent itself, then one of lower speed down to a turn on the
        spot, then a turn to the other side, and from standing a step in the
        reversed direction; see :class:`.ManeuverGuard`.
        """
        for choice in _choices(intent, standing=standing):
            if self.accepts(
                plan_for(choice), pose_plan_in_odometry, standing=standing
            ):
                return choice
        return None

    def choose_escape(
        self, intent: Intent, plan_for: PlanFor, pose_plan_in_odometry: Pose
    ) -> GuardDecision | None:
        """Return the decision that leads a standing robot out of the margin.

        It is the one with the largest least clearance, which may fall below
        the present one by no more than the error of the map.
        """
        out = []
        for choice in (*_choices(intent, standing=True), *ESCAPES):
            clearance = self.evaluate(plan_for(choice), pose_plan_in_odometry)
            if clearance.escapes(self.margin, self.map_error, GAINED):
                out.append((clearance.least, choice))
        return max(out, key=itemgetter(0))[1] if out else None

    def adjust_footsteps(
        self, plan: ManeuverPlan, pose_plan_in_odometry: Pose
    ) -> ManeuverPlan:
        """Return a plan with adjusted footsteps, if adjustment is enabled."""
        if self._footholds is None:
            return plan
        pose_plan_in_map = self.surroundings.pose_odometry_in_map.compose(
            pose_plan_in_odometry
        )
        return self._footholds.adjust(
            plan, pose_plan_in_map, self.surroundings.solids
        )

    def accepts(
        self,
        plan: ManeuverPlan,
        pose_plan_in_odometry: Pose,
        *,
        standing: bool,
    ) -> bool:
        """Return whether a maneuver may be executed.

        Inside the margin a standing robot may move out of it.
        """
        if not self.surroundings.solids:
            return True
        clearance = self.evaluate(plan, pose_plan_in_odometry)
        if clearance.least >= self.margin:
            return True
        return standing and clearance.escapes(self.margin, 0.0)

    def evaluate(
        self, plan: ManeuverPlan, pose_plan_in_odometry: Pose
    ) -> ManeuverClearance:
        """Return the clearance of the first step of a plan and its halt."""
        pose_plan_in_map = self.surroundings.pose_odometry_in_map.compose(
            pose_plan_in_odometry
        )
        landed = Pose(*plan.placements[2].tolist())
        halt = self.halt_after(plan)
        solids = self.surroundings.solids
        step = self._outline.along(plan, pose_plan_in_map, "step")
        rest = self._outline.along(
            halt, pose_plan_in_map.compose(landed), "all"
        )
        corners = np.concatenate([step, rest])
        clear = solids.swept_clearances(corners)
        now, last = (
            float(solids.swept_clearances(end)[0])
            for end in (corners[:1], corners[-1:])
        )
        return ManeuverClearance(now, float(clear.min()), last)

    def halt_after(self, plan: ManeuverPlan) -> ManeuverPlan:
        """Plan the halt after the first step of a plan.

        Its frame is that of the foot that lands.
        """
        back = Pose(*plan.placements[2].tolist()).inverse()
        return self._planner.plan_halt(
            first_foot=plan.first_foot.other,
            state=landing_state(plan),
            swing_start=back.compose(Pose(*plan.placements[1].tolist())),
        )


def _choices(intent: Intent, *, standing: bool) -> Iterator[GuardDecision]:
    """Yield decisions by their difference from an intent, the least first."""
    for share in SPEED_SCALES:
        yield GuardDecision(
            Intent(intent.heading, share * intent.speed_factor)
        )
    yield GuardDecision(
        Intent(-intent.heading, SPEED_SCALES[-1] * intent.speed_factor)
    )
    if standing:
        for heading in (intent.heading, -intent.heading, SHARP, -SHARP):
            yield GuardDecision(Intent(heading), back=True)
