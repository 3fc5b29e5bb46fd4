"""Plans, and their feet and soles computed independently of the package."""

from dataclasses import replace
from typing import Any

import numpy as np

from stepaside.core.poses import Array, Pose
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)

KINDS = ("start", "walk", "halt")


def reference_sole(plan: ManeuverPlan, row: int) -> Array:
    """Corners of the sole in a row of the placements. Shape (4, 2)."""
    sole = plan.schedule.settings.sole
    left = (plan.first_foot is Foot.LEFT) == (row % 2 == 0)
    low, high = (
        (-sole.inner, sole.outer) if left else (-sole.outer, sole.inner)
    )
    corners = [(u, v) for u in (sole.back, sole.front) for v in (low, high)]
    x, y, theta = plan.placements[row].tolist()
    return Pose(x, y, theta).transform_points(corners)


def reference_feet(plan: ManeuverPlan, time: float) -> tuple[int, ...]:
    """Rows of the feet on the floor; at a change only those on both sides."""
    gait = plan.schedule.settings
    if plan.schedule.standing:
        if time < gait.start_support:
            return (0, 1)
        time -= gait.start_support
    for step in range(plan.schedule.count):
        if time <= gait.single_support + 1e-12:
            return (step + 1,)
        time -= gait.single_support
        if time < gait.double_support - 1e-12:
            return (step + 1, step + 2)
        time -= gait.double_support
    return (plan.schedule.count, plan.schedule.count + 1)


def reference_corners(plan: ManeuverPlan, time: float) -> Array:
    """Corners of all soles on the floor. Shape (4 or 8, 2)."""
    feet = reference_feet(plan, time)
    return np.concatenate([reference_sole(plan, row) for row in feet])


def plan_of(
    kind: str,
    bearing: float = 0.3,
    *,
    gait: GaitSettings | None = None,
    foot: Foot = Foot.LEFT,
    direction: Direction = Direction.FORWARD,
    turn_to: float | None = None,
    **changes: Any,
) -> ManeuverPlan:
    """Plan of one kind; walk and halt follow the first step of a start."""
    planner = ManeuverPlanner(replace(gait or GaitSettings(), **changes))
    start = planner.plan(bearing, direction, first_foot=foot, standing=True)
    if kind == "start":
        return start
    end = start.sample([start.schedule.first_step_duration])
    back = Pose(*start.placements[2].tolist()).inverse()
    spin = Pose(0.0, 0.0, back.theta)
    x, y = back.transform_points(end.com)[0].tolist()
    vx, vy = spin.transform_points(end.com_velocity)[0].tolist()
    state = CenterState((x, y), (vx, vy))
    if kind == "halt":
        return planner.plan_halt(
            first_foot=foot.other, state=state, swing_start=back
        )
    return planner.plan(
        bearing if turn_to is None else turn_to,
        direction,
        first_foot=foot.other,
        state=state,
        swing_start=back,
    )
