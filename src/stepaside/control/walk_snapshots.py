"""What a walking robot does, as values for whoever looks on."""

from dataclasses import dataclass
from typing import NamedTuple

from ..core.poses import Pose
from ..locomotion.zmp.current_step import CurrentStep, resting_step, step_of
from ..locomotion.zmp.mpc import MpcResult
from ..locomotion.zmp.state_estimator import BodyState
from ..perception.measurement import Sighting
from ..planning import Foot, GaitSettings, ManeuverPlan
from ..robots.leg_kinematics import BodyReference
from .phase import Phase


class StepStarted(NamedTuple):
    """A step that a robot has begun.

    Attributes:
        plan: Maneuver whose first step it is.
        started: When it began, in [s]; not always on a tick.
        landing_time: When its foot shall land, in [s].
        foot: Foot that lands.
        landing: Where, in odometry.
        planning_time: Processor time that planning took, in [s]; None for a
            step that comes to rest.
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
    """What a robot plans and asks of its body at one tick, in odometry.

    Attributes:
        phase: What it is doing.
        gait: How it walks.
        plan: Maneuver being walked; None while standing.
        plan_frame: Pose of its frame.
        plan_started: When it began, in [s].
        left_foot: Pose of the left foot when it last stood.
        right_foot: Pose of the right foot, likewise.
        first_foot: Foot that swings, or will first.
        reference: What the body is asked for.
        zmp_reference: ZMP reference, in [m].
        sighting: The other as it was seen last; None if it is lost.
        torso_heading: Heading of the torso that is asked for, in [rad].
        estimate: The body's state, if it is estimated.
        solved: Answer of the MPC at this tick, if it was asked.
        adapted: Footsteps that feedback moved so far.
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
    sighting: Sighting | None
    torso_heading: float
    estimate: BodyState | None
    solved: MpcResult | None
    adapted: int

    def step(self, now: float) -> CurrentStep:
        """Step being made at a time, in [s]."""
        foot = self.first_foot
        if self.plan is None:
            rests = self.right_foot if foot is Foot.LEFT else self.left_foot
            return resting_step(rests, foot)
        return step_of(self.plan, self.plan_frame, now - self.plan_started)
