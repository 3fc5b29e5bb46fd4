"""From what a strategy wants to a plan that the body may walk."""

from collections.abc import Iterator

from ..core.poses import Pose
from ..locomotion.zmp.feedback_loop import Balance
from ..planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from ..strategies.knowledge import Intent
from ..strategies.strategy import Strategy
from .clearance.guard import Guard, GuardDecision


class ManeuverSelection:
    """Plans the maneuvers and halts of one robot.

    Attributes:
        planner: Of its gait.
        guard: What keeps it clear of what stands around, if anything.
    """

    def __init__(
        self, settings: GaitSettings, balance: Balance, guard: Guard | None
    ) -> None:
        """Prepare a planner.

        Args:
            settings: Gait.
            balance: What keeps the robot up, and fits plans to its state.
            guard: What keeps it clear of what stands around, if anything.
        """
        self.planner = ManeuverPlanner(settings)
        self.guard, self._balance = guard, balance
        self._loosely = False

    def tries(self) -> Iterator[None]:
        """What who stands tries one after the other, once with each foot.

        Where both fail by a map that may be off, each may try again to get
        out of too narrow a place; see :meth:`Guard.way_out`.
        """
        blurred = self.guard is not None and self.guard.surroundings.blur > 0.0
        try:
            for self._loosely in (False, True)[: 1 + blurred]:
                for _ in Foot:
                    yield
        finally:
            self._loosely = False

    def plan(
        self,
        intent: Intent,
        strategy: Strategy,
        state: CenterState,
        feet: tuple[Pose, Pose],
        foot: Foot,
        *,
        standing: bool,
    ) -> tuple[ManeuverPlan, CenterState] | None:
        """Plan what is wanted, or what comes nearest to it.

        Args:
            intent: What is wanted.
            strategy: Who wants it.
            state: Present CoM in the frame of the support foot.
            feet: Support foot and swing foot in odometry.
            foot: Foot that swings.
            standing: Whether the robot stands.

        Returns:
            The plan and the state that it begins with; None if it had
            better stand.
        """
        support = feet[0]
        swing_start = support.inverse().compose(feet[1])

        def plan_of(choice: GuardDecision, state: CenterState) -> ManeuverPlan:
            direction, wanted = strategy.direction, choice.intent
            if choice.back:
                direction = Direction(-direction.value)
            plan = self.planner.plan(
                wanted.heading,
                direction,
                first_foot=foot,
                state=state,
                swing_start=swing_start,
                standing=standing,
                saturated=strategy.saturated,
                speed_factor=wanted.speed_factor,
                pace=wanted.pace,
            )
            if self.guard is None:
                return plan
            return self.guard.fit(plan, support)

        chosen: GuardDecision | None = GuardDecision(intent)
        if self.guard is not None:
            # Fitting moves no foot, so it can wait until the choice is made.
            def planned(choice: GuardDecision) -> ManeuverPlan:
                return plan_of(choice, state)

            if self._loosely:
                chosen = self.guard.way_out(intent, planned, support)
            else:
                chosen = self.guard.choose(
                    intent, planned, support, standing=standing
                )
        if chosen is None:
            return None
        walked = chosen
        if standing:
            return plan_of(walked, state), state
        return self._balance.fit(
            lambda state: plan_of(walked, state), state, support
        )
