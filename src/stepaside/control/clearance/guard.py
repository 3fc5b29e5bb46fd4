"""Only maneuvers after which a robot can still stop clear of everything.

Standing is safe against what rests. So a maneuver is walked only if its first
step *and* the halt after it keep clear of all that is known. Else the robot
halts, which was found to be clear when the step before was accepted: by
induction a robot that starts clear touches nothing that rests, whatever its
strategy wants.

A map that was seen may be off by a cell. Who stands by it where no step keeps
clear, since every step sways, would stand there for ever: once neither foot
has another way, it takes the one out that comes least near, by a cell at most.
"""

from collections.abc import Callable, Iterator
from math import pi
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from ...core.poses import Pose
from ...planning import ManeuverPlan, ManeuverPlanner
from ...planning.steady_gait import landing_state
from ...strategies.knowledge import Intent
from .footholds import Footholds
from .surroundings import Surroundings
from .swept_outline import BodyOutline

SLOWER = (1.0, 0.5, 0.05)  # shares of the wanted speed; the last but turns
SHARP = 2.0  # heading of a step back where no other is clear, in [rad]
NEARER = 1e-6  # than this no robot comes that is too near already, in [m]
GAINED = 0.004  # by a way out that comes nearer meanwhile, in [m]


class GuardDecision(NamedTuple):
    """What a robot may do instead of what is wanted.

    Attributes:
        intent: Heading and speed.
        back: Whether it drives the other way: forward where its strategy
            drives backward.
    """

    intent: Intent
    back: bool = False


WAYS_OUT = tuple(
    GuardDecision(Intent(heading), back)
    for heading in (pi, -pi)
    for back in (False, True)
)
PlanFor = Callable[[GuardDecision], ManeuverPlan]


class ManeuverClearance(NamedTuple):
    """How clear a maneuver is.

    Attributes:
        now: Distance of the body from everything as it stands, in [m].
        least: Least distance during the first step and the halt, in [m].
        last: Distance of the body after the halt, in [m].
    """

    now: float
    least: float
    last: float

    def leaves(
        self, margin: float, blur: float, gained: float = NEARER
    ) -> bool:
        """Whether it leads out of a place that is too narrow.

        Args:
            margin: Distance from which a place is not too narrow, in [m].
            blur: How much nearer it may come on the way, in [m].
            gained: By how much it ends farther, or at the margin, in [m].
        """
        farther = self.last > min(self.now + gained, margin)
        near = self.least >= self.now - blur - NEARER
        return self.now < margin and farther and near


class Guard:
    """Keeps a robot clear of what it knows of.

    Attributes:
        surroundings: What it knows of.
        margin: Distance that it keeps, in [m].
    """

    def __init__(
        self,
        surroundings: Surroundings,
        outline: BodyOutline,
        planner: ManeuverPlanner,
        *,
        margin: float,
        footholds: Footholds | None = None,
    ) -> None:
        """Guard one robot.

        Args:
            surroundings: What it knows of.
            outline: Of its body.
            planner: Of its gait, for the halts.
            margin: Distance that it keeps, in [m].
            footholds: What moves footsteps out of what stands around, with
                the MPC; nothing by default.
        """
        self._footholds = footholds
        self.surroundings, self.margin = surroundings, margin
        self._outline, self._planner = outline, planner

    def choose(
        self,
        intent: Intent,
        plan_for: PlanFor,
        support: Pose,
        *,
        standing: bool,
    ) -> GuardDecision | None:
        """What comes nearest to what is wanted and keeps clear.

        Args:
            intent: What is wanted.
            plan_for: Plans from a choice.
            support: Frame of the plans in odometry.
            standing: Whether the robot stands; then it may also leave a
                place that is too near to something.

        Returns:
            The first choice that keeps clear: as wanted, then slower and
            slower, down to a turn on the spot, then a turn the other way,
            and from standing a step back, sharply if need be; None if the
            robot had better stand.
        """
        for choice in _choices(intent, standing=standing):
            if self.accepts(plan_for(choice), support, standing=standing):
                return choice
        return None

    def way_out(
        self, intent: Intent, plan_for: PlanFor, support: Pose
    ) -> GuardDecision | None:
        """How who stands gets out of a place that a map calls too narrow.

        Args:
            intent: What is wanted.
            plan_for: Plans from a choice.
            support: Frame of the plans in odometry.

        Returns:
            The way out that comes least near to anything, nearer than now by
            no more than the map may be off; None if there is none.
        """
        blur = self.surroundings.blur
        out = []
        for choice in (*_choices(intent, standing=True), *WAYS_OUT):
            passage = self.passage(plan_for(choice), support)
            if passage.leaves(self.margin, blur, GAINED):
                out.append((passage.least, choice))
        return max(out, key=itemgetter(0))[1] if out else None

    def fit(self, plan: ManeuverPlan, support: Pose) -> ManeuverPlan:
        """A plan with footsteps that keep clear, if those are to be moved.

        Args:
            plan: The plan.
            support: Its frame in odometry.
        """
        if self._footholds is None:
            return plan
        frame = self.surroundings.frame.compose(support)
        return self._footholds.kept(plan, frame, self.surroundings.solids)

    def accepts(
        self, plan: ManeuverPlan, support: Pose, *, standing: bool
    ) -> bool:
        """Whether a maneuver may be walked.

        Args:
            plan: The maneuver.
            support: Its frame in odometry.
            standing: Whether the robot stands; if it is nearer to something
                than the margin, it may then move away.
        """
        if not self.surroundings.solids.shapes:
            return True
        passage = self.passage(plan, support)
        if passage.least >= self.margin:
            return True
        return standing and passage.leaves(self.margin, 0.0)

    def passage(self, plan: ManeuverPlan, support: Pose) -> ManeuverClearance:
        """How clear the first step of a plan and the halt after it are."""
        frame = self.surroundings.frame.compose(support)
        landed = Pose(*plan.placements[2].tolist())
        halt = self.halt_after(plan)
        solids = self.surroundings.solids
        step = self._outline.along(plan, frame, "step")
        rest = self._outline.along(halt, frame.compose(landed), "all")
        corners = np.concatenate([step, rest])
        clear = solids.swept_clearances(corners)
        now, last = (
            float(solids.swept_clearances(end)[0])
            for end in (corners[:1], corners[-1:])
        )
        return ManeuverClearance(now, float(clear.min()), last)

    def halt_after(self, plan: ManeuverPlan) -> ManeuverPlan:
        """Halt with which the robot can end the first step of a plan.

        Its frame is that of the foot that lands.
        """
        back = Pose(*plan.placements[2].tolist()).inverse()
        return self._planner.plan_halt(
            first_foot=plan.first_foot.other,
            state=landing_state(plan),
            swing_start=back.compose(Pose(*plan.placements[1].tolist())),
        )


def _choices(intent: Intent, *, standing: bool) -> Iterator[GuardDecision]:
    """What comes nearest to an intent, the nearest first."""
    for share in SLOWER:
        yield GuardDecision(
            Intent(intent.heading, share * intent.speed_factor)
        )
    yield GuardDecision(
        Intent(-intent.heading, SLOWER[-1] * intent.speed_factor)
    )
    if standing:
        for heading in (intent.heading, -intent.heading, SHARP, -SHARP):
            yield GuardDecision(Intent(heading), back=True)
