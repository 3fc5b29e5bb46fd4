"""Planning of the maneuver that an intent and the guard allow."""

from collections.abc import Callable, Iterator
from typing import NamedTuple, Protocol

from ..core.poses import Pose
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
from ..strategies.knowledge import Intent
from .locomotion import MotionRequest
from .zmp.open_loop import OpenLoop


class GuardDecision(NamedTuple):
    """Intent that the guard accepts in place of the requested one."""

    intent: Intent  # heading and speed
    back: bool = False  # whether the driving direction is reversed


PlanFor = Callable[[GuardDecision], ManeuverPlan]


class ManeuverGuard(Protocol):
    """Filter of intents that keeps a robot clear of known obstacles.

    Plans are in the frame of the support foot, whose pose in odometry is
    given; a function plans a decision. See :class:`.Guard`.
    """

    @property
    def map_error(self) -> float:
        """Largest position error of the obstacles, in [m]."""

    def note(self, measurement: RobotState, pose: Pose) -> None:
        """Update the obstacles; the pose of the CoM is in odometry."""

    def choose(
        self,
        intent: Intent,
        plan_for: PlanFor,
        pose_plan_in_odometry: Pose,
        *,
        standing: bool,
    ) -> GuardDecision | None:
        """Return the accepted decision closest to an intent; None to stand."""

    def choose_escape(
        self, intent: Intent, plan_for: PlanFor, pose_plan_in_odometry: Pose
    ) -> GuardDecision | None:
        """Return the decision that leads out of the margin from standing."""

    def adjust_footsteps(
        self, plan: ManeuverPlan, pose_plan_in_odometry: Pose
    ) -> ManeuverPlan:
        """Return a plan with adjusted footsteps, if adjustment is enabled."""


class ManeuverSelection:
    """Plans the maneuvers and halts of one robot."""

    def __init__(
        self,
        settings: GaitSettings,
        balance: OpenLoop,
        guard: ManeuverGuard | None,
    ) -> None:
        """Prepare a planner; balance control fits plans to the state."""
        self.planner = ManeuverPlanner(settings)
        self.guard, self._balance = guard, balance
        self._relaxed = False

    def start_attempts(self) -> Iterator[None]:
        """Yield the start attempts of a standing robot: once with each foot.

        With a map that may be off, each foot then has a second attempt, with
        relaxed clearance; see :meth:`ManeuverGuard.choose_escape`.
        """
        blurred = self.guard is not None and self.guard.map_error > 0.0
        try:
            for self._relaxed in (False, True)[: 1 + blurred]:
                for _ in Foot:
                    yield
        finally:
            self._relaxed = False

    def plan(
        self,
        request: MotionRequest,
        state: CenterState,
        feet: tuple[Pose, Pose],
        foot: Foot,
        *,
        standing: bool,
    ) -> tuple[ManeuverPlan, CenterState] | None:
        """Plan an intent, or the accepted decision closest to it.

        ``state``: Present CoM in the frame of the support foot. ``feet``:
        Poses of support foot and swing foot in odometry. The plan and the
        state that it begins with; None to stand.
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
                drive=TemplateDrive(
                    request.saturated, chosen.speed_factor, chosen.pace
                ),
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
        return self._balance.fit(
            lambda state: plan_of(walked, state), state, support
        )
