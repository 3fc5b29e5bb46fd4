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
    """Step that began at a tick."""

    plan: ManeuverPlan  # maneuver whose first step it is
    started: float  # start time [s]; not always on a tick
    landing_time: float  # planned landing time [s]
    foot: Foot  # foot that lands
    landing: Pose  # planned landing pose, in odometry
    # processor time of planning [s]; None for a halt
    planning_time: float | None
    velocity_jump: float  # jump of the CoM velocity reference [m/s]


@dataclass(frozen=True, slots=True)
class WalkState:
    """Plan, references and estimates at one tick, in odometry."""

    phase: Phase
    gait: GaitSettings
    plan: ManeuverPlan | None  # current maneuver; None while standing
    plan_frame: Pose
    plan_started: float  # start time of the plan [s]
    left_foot: Pose  # last stance pose of the left foot
    right_foot: Pose  # last stance pose of the right foot
    first_foot: Foot  # foot that swings now, or will swing first
    reference: BodyReference
    zmp_reference: tuple[float, float]  # ZMP reference [m]
    torso_heading: float  # reference heading of the torso [rad]
    estimate: BodyState | None  # estimated state of the body, if any
    solved: MpcResult | None  # result of the MPC at this tick, if it ran
    adapted: int  # number of footsteps that feedback has moved so far

    def step(self, now: float) -> CurrentStep:
        """Return the step in progress at a time, in [s]."""
        foot = self.first_foot
        if self.plan is None:
            support = self.right_foot if foot is Foot.LEFT else self.left_foot
            return resting_step(support, foot)
        return first_step_of(
            self.plan, self.plan_frame, now - self.plan_started
        )
