"""Test that the CoM of a plan compensates the swing reaction."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from stepaside.planning import (
    PRESETS,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)
from stepaside.planning.gait_settings import SwingProfile
from stepaside.planning.push_bound import steady_plan

FAST = PRESETS["fast"]
TINY = 1e-4  # between samples of a derivative, in [s]


def some_plan(gait: GaitSettings, *, standing: bool) -> ManeuverPlan:
    """A turning plan, from standing or in the middle of a walk."""
    planner = ManeuverPlanner(gait)
    if standing:
        return planner.plan(
            0.7, Direction.BACKWARD, first_foot=Foot.LEFT, standing=True
        )
    return steady_plan(planner, 0.7, Direction.BACKWARD, first_foot=Foot.RIGHT)


def inside_phases(plan: ManeuverPlan) -> np.ndarray:
    """Instants away from those at which a phase ends, in [s]."""
    starts = plan.schedule.starts
    shares = np.array([0.1, 0.35, 0.6, 0.9])
    times: np.ndarray = (
        starts[:-1, None] + np.diff(starts)[:, None] * shares
    ).ravel()
    return times


@pytest.mark.parametrize("profile", ["minimum-jerk", "even"])
@pytest.mark.parametrize("standing", [False, True])
def test_the_com_falls_away_from_the_pivot(
    standing: bool, profile: SwingProfile
) -> None:
    gait = replace(FAST, swing_profile=profile)
    plan = some_plan(gait, standing=standing)
    times = inside_phases(plan)
    before, now, after = (
        plan.sample(times + shift) for shift in (-TINY, 0.0, TINY)
    )
    bent = (after.com_velocity - before.com_velocity) / (2.0 * TINY)
    falls = gait.eta**2 * (now.com - now.pivot)
    np.testing.assert_allclose(bent, falls, atol=1e-4)


@pytest.mark.parametrize("profile", ["minimum-jerk", "even"])
@pytest.mark.parametrize("standing", [False, True])
def test_the_zmp_is_ahead_of_the_pivot_by_the_feet_s_acceleration(
    standing: bool, profile: SwingProfile
) -> None:
    """Turning feet: what swings is the point of the foot at its anchor."""
    gait = replace(FAST, swing_profile=profile)
    plan = some_plan(gait, standing=standing)
    times = inside_phases(plan)
    h = 1e-3

    def anchors(shift: float) -> np.ndarray:
        found = plan.sample(times + shift)
        feet: np.ndarray = found.left_foot[:, :2] + found.right_foot[:, :2]
        return feet

    moved = anchors(h) - 2.0 * anchors(0.0) + anchors(-h)
    found = plan.sample(times)
    shift = (found.zmp - found.pivot) / gait.swing_reaction
    # The anchor is 20 mm ahead of the ankle, and turns with it.
    turned = gait.zmp_forward * 0.3 * 6.6 / gait.single_support**2
    np.testing.assert_allclose(shift, moved / h**2, atol=turned)
    assert np.abs(shift).max() > 9.0  # [m/s^2]: there is something to see


@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("bearing", [0.0, pi / 4, -pi / 2])
def test_the_fast_gait_lands_soon_with_its_zmp_well_inside(
    bearing: float, direction: Direction
) -> None:
    plan = ManeuverPlanner(FAST).plan(
        bearing, direction, first_foot=Foot.LEFT, standing=True
    )
    landing = plan.schedule.first_step_duration - FAST.double_support
    assert landing <= 0.45
    assert plan.margin() > 0.03


@pytest.mark.parametrize("saturated", [False, True])
@pytest.mark.parametrize("bearing", [0.0, 0.6, pi / 2, -pi, 1e-9])
def test_no_foot_goes_farther_than_the_outer_stride(
    bearing: float, saturated: bool
) -> None:
    plan = ManeuverPlanner(FAST).plan(
        bearing,
        Direction.FORWARD,
        first_foot=Foot.LEFT,
        standing=True,
        drive=TemplateDrive(saturated),
    )
    assert FAST.outer_stride is not None
    # Between two landings of a foot: two steps, each along a chord.
    ways = np.hypot(*np.diff(plan.placements[1::2, :2], axis=0).T)
    assert ways.max() <= 2.0 * FAST.outer_stride + 1e-12
    turned = abs(plan.placements[2, 2])
    if FAST.stride_share(turned) == 1.0:
        assert turned <= 2.0 * (0.09 - 0.0832) / FAST.foot_spacing + 1e-9
        assert ways[-1] > 1.8 * FAST.stride
