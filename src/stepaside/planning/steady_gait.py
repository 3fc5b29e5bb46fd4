"""Landing state of a step, and the periodic state of a steady walk."""

import numpy as np

from ..core.poses import Pose
from .footsteps import Foot
from .maneuver import CenterState, ManeuverPlanner
from .path import Direction
from .plan import ManeuverPlan

STATE_SIZE = 4  # position and velocity


def landing_state(plan: ManeuverPlan) -> CenterState:
    """Return the CoM state at the first landing, in that foot's frame."""
    samples = plan.sample(plan.schedule.first_step_sampler)
    back = Pose(*plan.placements[2].tolist()).inverse()
    x, y = samples.com[0].tolist()
    vx, vy = samples.com_velocity[0].tolist()
    position = back.compose(Pose(x, y, 0.0))
    velocity = Pose(0.0, 0.0, back.theta).compose(Pose(vx, vy, 0.0))
    return CenterState(position[:2], velocity[:2])


def steady_plan(
    planner: ManeuverPlanner,
    bearing: float,
    direction: Direction,
    *,
    first_foot: Foot,
) -> ManeuverPlan:
    """Return the plan of a steady walk with a constant bearing.

    The map from the state at one landing to that at the next is affine; the
    periodic state is the fixed point of two steps.

    ``bearing``: Desired heading in the frame of each support foot, in [rad].
    The plan, whose first step begins in the periodic state.
    """

    def plan_from(
        state: np.ndarray, foot: Foot, swing_start: Pose | None = None
    ) -> ManeuverPlan:
        x, y, vx, vy = state.tolist()
        return planner.plan(
            bearing,
            direction,
            first_foot=foot,
            state=CenterState((x, y), (vx, vy)),
            swing_start=swing_start,
        )

    def recur(state: np.ndarray) -> np.ndarray:
        for foot in (first_foot, first_foot.other):
            position, velocity = landing_state(plan_from(state, foot))
            state = np.array([*position, *velocity])
        return state

    origin = recur(np.zeros(STATE_SIZE))
    columns = [recur(unit) - origin for unit in np.eye(STATE_SIZE)]
    state = np.linalg.solve(
        np.eye(STATE_SIZE) - np.column_stack(columns), origin
    )
    before = plan_from(state, first_foot.other)
    left_behind = Pose(*before.placements[2].tolist()).inverse()
    return plan_from(state, first_foot, left_behind)
