"""Test the adjustment of footsteps to half planes around obstacles."""

from math import cos, pi, sin

import numpy as np
import pytest

from stepaside.arena import Box, Disc, Obstacle, ObstacleSet
from stepaside.core.poses import Array, Pose
from stepaside.locomotion.control_settings import StabiliserSettings
from stepaside.locomotion.guard import FootstepAdjustment
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)

GAIT = GaitSettings()
PLANNER = ManeuverPlanner(GAIT)
REACH = StabiliserSettings()
NEEDS = 0.2
HOLDS = FootstepAdjustment(PLANNER, REACH, NEEDS)
FRAME = Pose(0.4, -0.3, 2.1)  # of the plan in the room
NEAR = 2.0 * GAIT.sole.inner + REACH.gap
FAR = GAIT.foot_spacing + REACH.reach_outward


def plan(
    bearing: float = 0.0,
    foot: Foot = Foot.LEFT,
    direction: Direction = Direction.BACKWARD,
) -> ManeuverPlan:
    state = CenterState((0.01, 0.025 * foot.value), (0.0, -0.04 * foot.value))
    return PLANNER.plan(bearing, direction, first_foot=foot, state=state)


def middles(p: ManeuverPlan, frame: Pose = FRAME) -> Array:
    """Midway between the feet after each step, in the room."""
    found = []
    for step in p.footsteps:
        half = 0.5 * GAIT.foot_spacing * step.foot.value
        place = Pose(step.x, step.y, step.theta).compose(Pose(0, -half, 0))
        found.append(frame.compose(place)[:2])
    return np.array(found)


def beside(p: ManeuverPlan, away: float, angle: float) -> tuple[Obstacle, ...]:
    """A wall across the way, beyond where the plan ends or before that."""
    x, y = middles(p)[-1]
    out = FRAME.theta + angle
    reach = away + 0.5
    return (Box(x + reach * cos(out), y + reach * sin(out), 1, 3, out),)


def strides(p: ManeuverPlan) -> list[tuple[float, float]]:
    """Each footstep from the one before, ahead and outward, in [m]."""
    found, side = [], float(p.first_foot.value)
    for before, after in zip(
        p.placements[1:-1], p.placements[2:], strict=True
    ):
        x, y, _ = Pose(*before).inverse().compose(Pose(*after))
        found.append((float(x), side * float(y)))
        side = -side
    return found


def clear(p: ManeuverPlan, solids: tuple[Obstacle, ...]) -> Array:
    found: Array = np.min([s.clearance(middles(p)) for s in solids], axis=0)
    return found


@pytest.mark.parametrize("solids", [(), (Disc(3.0, 0.0, 0.5),)])
def test_without_obstacles_nearby_the_plan_is_unchanged(
    solids: tuple[Obstacle, ...],
) -> None:
    wanted = plan(0.4)
    assert HOLDS.adjust(wanted, FRAME, ObstacleSet(solids)) is wanted


@pytest.mark.parametrize("foot", Foot)
@pytest.mark.parametrize("bearing", [-2.0, -0.5, 0.0, 0.8])
@pytest.mark.parametrize("angle", [pi, 2.6, -2.4])
def test_every_footstep_stays_on_its_side_of_a_wall(
    foot: Foot, bearing: float, angle: float
) -> None:
    """Plan that comes 4 cm too near; reach limits hold."""
    wanted = plan(bearing, foot)
    wall = beside(wanted, NEEDS - 0.04, angle)
    assert clear(wanted, wall).min() < NEEDS - 0.03
    kept = HOLDS.adjust(wanted, FRAME, ObstacleSet(wall))
    assert kept is not wanted
    assert clear(kept, wall).min() >= NEEDS - 1e-6
    feet = kept.placements
    np.testing.assert_array_equal(feet[:, 2], wanted.placements[:, 2])
    np.testing.assert_array_equal(feet[:2], wanted.placements[:2])
    for legs, asked in zip(strides(kept), strides(wanted), strict=True):
        most = np.maximum([GAIT.stride, FAR], [abs(asked[0]), asked[1]])
        assert abs(legs[0]) <= most[0] + 1e-6 and legs[1] <= most[1] + 1e-6
        assert legs[1] >= min(NEAR, asked[1]) - 1e-6


@pytest.mark.parametrize("seed", range(5))
def test_no_other_footsteps_change_the_plan_less(seed: int) -> None:
    """Around a disc; those that are drawn keep the same half planes."""
    random = np.random.default_rng(seed)
    wanted = plan(float(random.uniform(-1, 1)))
    x, y = middles(wanted)[-1]
    out = FRAME.theta + pi + float(random.uniform(-0.6, 0.6))
    reach = 0.15 + NEEDS - 0.02
    disc = Disc(x + reach * cos(out), y + reach * sin(out), 0.15)
    kept = HOLDS.adjust(wanted, FRAME, ObstacleSet((disc,)))
    assert kept is not wanted
    assert clear(kept, (disc,)).min() >= NEEDS - 1e-6
    rows, least = HOLDS._half_planes(wanted, FRAME, ObstacleSet((disc,)))
    reached, low, high = HOLDS._within_reach(wanted)
    target = wanted.placements[2:, :2].ravel()

    def cost(steps: Array) -> float:
        moved = (steps - target).reshape(-1, 2)
        return float((np.diff(moved, axis=0, prepend=0.0) ** 2).sum())

    best = kept.placements[2:, :2].ravel()
    tried = 0
    for _ in range(4000):
        steps = best + random.normal(0.0, 0.003, best.size)
        inside = (rows @ steps >= least).all() and (
            (reached @ steps >= low) & (reached @ steps <= high)
        ).all()
        if inside:
            tried += 1
            assert cost(steps) >= cost(best) - 1e-9
    assert cost(best) > 1e-5
