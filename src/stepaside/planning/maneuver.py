"""Maneuver planning: path, footsteps, ZMP and CoM (paper, Sec. III-B to E)."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.errors import (
    LEAST,
    PlanError,
    check_bearing,
    check_finite,
    check_within,
)
from ..core.poses import Array, Pose, rotate
from ..theory import laws
from .gait_settings import GaitSettings
from .path import Direction, Foot, UnicycleTrajectory, place_footsteps
from .plan import ManeuverPlan
from .schedule import Schedule


class CenterState(NamedTuple):
    """Present state of the CoM in the frame of the next support foot."""

    position: tuple[float, float]  # sagittal, coronal [m]
    velocity: tuple[float, float]  # [m/s]


class TemplateDrive(NamedTuple):
    """Speed and steering law of the template over one maneuver.

    A speed factor leaves step durations and turns as they are. A sharp turn
    reduces the speed further.
    """

    saturated: bool = False  # turns by (6) instead of (8)
    speed_factor: float = 1.0  # of the gait's speed and stride, in (0, 1]


FULL_SPEED = TemplateDrive()


class ManeuverPlanner:
    """Maneuver planner for one gait, for pursuer and evader alike."""

    def __init__(self, settings: GaitSettings) -> None:
        self.settings = settings
        self._schedules: dict[tuple[int, bool], Schedule] = {}

    def schedule(self, count: int, *, standing: bool) -> Schedule:
        """Return the schedule of ``count`` footsteps, built at first use."""
        key = (count, standing)
        if key not in self._schedules:
            self._schedules[key] = Schedule(
                self.settings, count, standing=standing
            )
        return self._schedules[key]

    def plan(
        self,
        bearing: float,
        direction: Direction,
        *,
        first_foot: Foot,
        state: CenterState | None = None,
        swing_start: Pose | None = None,
        standing: bool = False,
        drive: TemplateDrive = FULL_SPEED,
        count: int | None = None,
    ) -> ManeuverPlan:
        r"""Plan one maneuver (Fig. 4, red box), from the present CoM state.

        Args:
            bearing: Desired heading :math:`\theta^*` in the frame of the
                next support foot, in [rad].
            direction: Forward for the pursuer, backward for the evader.
            first_foot: Foot that lands first; the other one supports.
            state: Present CoM; None when standing means at rest midway
                between the feet.
            swing_start: Pose of the first swing foot in the frame of the
                support foot; abreast of it by default.
            standing: Whether the plan begins with a double support.
            drive: Speed and steering law of the template.
            count: Number of footsteps; by default the horizon of the gait.

        Raises:
            PlanError: If the bearing is not finite or beyond one turn, the
                state is not finite or missing, or the speed factor is out
                of range.
        """
        check_bearing(bearing, "bearing")
        saturated, speed_factor = drive
        check_within(speed_factor, LEAST, 1.0, "speed_factor", "1")
        gait = self.settings
        schedule = self.schedule(
            gait.horizon if count is None else count, standing=standing
        )
        turning = laws.saturated_rate if saturated else laws.proportional_rate
        turn = turning(bearing, gait.gain) * gait.path_interval
        share = min(speed_factor, gait.stride_share(turn))
        trajectory = UnicycleTrajectory(
            bearing, share * gait.speed, gait.gain, direction, saturated
        )
        placements = np.zeros((schedule.count + 2, 3))
        placements[2:] = place_footsteps(
            trajectory,
            count=schedule.count,
            stride=share * gait.stride,
            foot_spacing=gait.foot_spacing,
            first_foot=first_foot,
        )
        abreast = Pose(0.0, gait.foot_spacing * first_foot.value, 0.0)
        placements[0] = swing_start or abreast
        inputs = _inputs(schedule, placements, state)
        return ManeuverPlan(
            schedule, bearing, direction, first_foot, placements, inputs
        )

    def placed(self, plan: ManeuverPlan, placements: Array) -> ManeuverPlan:
        """Return a plan with other footsteps, from the same state.

        The placements are laid out as in the plan; the first two are the same.
        """
        state = CenterState(_pair(plan.inputs[-1]), _pair(plan.start_velocity))
        inputs = _inputs(plan.schedule, placements, state)
        return replace(plan, placements=placements, inputs=inputs)

    def plan_halt(
        self,
        *,
        first_foot: Foot,
        state: CenterState,
        swing_start: Pose,
    ) -> ManeuverPlan:
        """Plan a halt: one last step that brings the feet abreast."""
        schedule = self.schedule(1, standing=False)
        spacing = self.settings.foot_spacing * first_foot.value
        placements = np.array(
            [swing_start, (0.0, 0.0, 0.0), (0.0, spacing, 0.0)]
        )
        inputs = _inputs(schedule, placements, state)
        return ManeuverPlan(
            schedule, 0.0, Direction.FORWARD, first_foot, placements, inputs
        )


def _inputs(
    schedule: Schedule, placements: Array, state: CenterState | None
) -> Array:
    """Assemble the inputs of the constant maps. Shape (inputs, 2).

    Without a state, the CoM is at rest midway between the feet.
    """
    ahead = schedule.settings.zmp_forward
    anchors = placements[:, :2] + rotate(ahead, 0.0, placements[:, 2]).T
    if state is None:
        if not schedule.standing:
            raise PlanError("state must be given unless the robot stands")
        state = CenterState(_pair(0.5 * (anchors[0] + anchors[1])), (0.0, 0.0))
    (x, y), (vx, vy) = state
    check_finite(x + y, "CoM position", "m")
    check_finite(vx + vy, "CoM velocity", "m/s")
    n = schedule.count
    inputs = np.zeros((schedule.input_count, 2))
    inputs[: n + 1] = anchors[1:]
    inputs[n + 1] = (x, y) if schedule.standing else inputs[0]
    if schedule.has_swing_reaction:
        inputs[n + 2] = anchors[0]
    inputs[-1] = x, y
    row, eta = schedule.dcm_start_map, schedule.settings.eta
    planned = row @ inputs
    inputs[-2] = (np.array([x + vx / eta, y + vy / eta]) - planned) / row[-2]
    return inputs


def _pair(values: Array) -> tuple[float, float]:
    x, y = values.tolist()
    return x, y


def landing_state(plan: ManeuverPlan) -> CenterState:
    """Return the CoM state at the first landing, in that foot's frame."""
    samples = plan.sample(plan.schedule.first_step_sampler)
    back = Pose(*plan.placements[2].tolist()).inverse()
    x, y = samples.com[0].tolist()
    vx, vy = samples.com_velocity[0].tolist()
    position = back.compose(Pose(x, y, 0.0))
    velocity = Pose(0.0, 0.0, back.theta).compose(Pose(vx, vy, 0.0))
    return CenterState(position[:2], velocity[:2])
