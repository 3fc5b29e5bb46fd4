"""State of a walking robot at one tick, as values."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ..core.poses import Pose
from ..planning import Foot, GaitSettings, ManeuverPlan
from ..robots.leg_kinematics import BodyReference
from .zmp.current_step import CurrentStep, first_step_of, resting_step
from .zmp.mpc import MpcResult
from .zmp.state_estimator import BodyState


class Phase(Enum):
    """Phase of motion of a robot, by its own estimate."""

    STANDING = "standing"
    WALKING = "walking"
    HALTING = "halting"
    FALLEN = "fallen"


class StepStarted(NamedTuple):
    """Step that began at a tick.

    Attributes:
        plan: Maneuver whose first step it is.
        started: Start time, in [s]; not always on a tick.
        landing_time: Planned landing time, in [s].
        foot: Foot that lands.
        landing: Planned landing pose, in odometry.
        planning_time: Processor time of planning, in [s]; None for a halt.
        velocity_jump: Jump of the CoM velocity reference, in [m/s].
    """

    plan: ManeuverPlan
    started: float
    landing_time: float
    foot: Foot
    landing: Pose
    planning_time: float | None
    velocity_jump: float


@dataclass(frozen=True, slots=True)
class WalkState:
    """Plan, references and estimates at one tick, in odometry.

    Attributes:
        phase: Phase of motion.
        gait: Gait.
        plan: Current maneuver; None while standing.
        plan_frame: Pose of the plan frame.
        plan_started: Start time of the plan, in [s].
        left_foot: Last stance pose of the left foot.
        right_foot: Last stance pose of the right foot.
        first_foot: Foot that swings now, or will swing first.
        reference: Body reference.
        zmp_reference: ZMP reference, in [m].
        torso_heading: Reference heading of the torso, in [rad].
        estimate: Estimated state of the body, if any.
        solved: Result of the MPC at this tick, if it ran.
        adapted: Number of footsteps that feedback has moved so far.
    """

    phase: Phase
    gait: GaitSettings
    plan: ManeuverPlan | None
    plan_frame: Pose
    plan_started: float
    left_foot: Pose
    right_foot: Pose
    first_foot: Foot
    reference: BodyReference
    zmp_reference: tuple[float, float]
    torso_heading: float
    estimate: BodyState | None
    solved: MpcResult | None
    adapted: int

    def step(self, now: float) -> CurrentStep:
        """Return the step in progress at a time, in [s]."""
        foot = self.first_foot
        if self.plan is None:
            support = self.right_foot if foot is Foot.LEFT else self.left_foot
            return resting_step(support, foot)
        return first_step_of(
            self.plan, self.plan_frame, now - self.plan_started
        )
