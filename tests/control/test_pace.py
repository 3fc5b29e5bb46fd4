"""Test walks at a reduced step rate."""

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest

from stepaside.control.strategy_runner import MAX_PACE_CHANGE, next_pace
from stepaside.core.poses import Pose
from stepaside.planning import (
    PRESETS,
    Direction,
    Foot,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)
from stepaside.planning.maneuver import landing_state
from stepaside.strategies import Evasion, Knowledge, Limits

FAST = PRESETS["fast"]
LIMITS = Limits(FAST.speed, FAST.gain, FAST.stride, FAST.step_duration)


def next_plan(
    planner: ManeuverPlanner, before: ManeuverPlan, pace: float
) -> ManeuverPlan:
    """Plan that follows the first step of another."""
    back = Pose(*before.placements[2].tolist()).inverse()
    return planner.plan(
        before.bearing,
        before.direction,
        first_foot=before.first_foot.other,
        state=landing_state(before),
        swing_start=back,
        drive=TemplateDrive(pace=pace),
    )


def walk_at(paces: list[float], bearing: float = 0.6) -> list[ManeuverPlan]:
    """Plans of a walk, each with its own pace."""
    planner = ManeuverPlanner(FAST)
    plans = [
        planner.plan(
            bearing,
            Direction.BACKWARD,
            first_foot=Foot.LEFT,
            standing=True,
            drive=TemplateDrive(pace=paces[0]),
        )
    ]
    for pace in paces[1:]:
        plans.append(next_plan(planner, plans[-1], pace))
    return plans


@pytest.mark.parametrize(
    "paces", [[1.0, 1.0, 0.75, 0.5, 0.75, 1.0], [0.5, 0.75, 1.0, 0.75, 0.5]]
)
def test_the_com_is_continuous_and_the_zmp_in_the_sole_as_paces_change(
    paces: list[float],
) -> None:
    """By as much a step as control lets it change."""
    plans = walk_at(paces)
    for before, after in pairwise(plans):
        state, begun = landing_state(before), after.sample([0.0])
        np.testing.assert_allclose(begun.com[0], state.position, atol=1e-12)
        np.testing.assert_allclose(
            begun.com_velocity[0], state.velocity, atol=1e-12
        )
        assert after.margin(after.schedule.first_step_duration) > 0.015


def test_pace_changes_gradually_in_a_walk() -> None:
    assert next_pace(1.0, 0.5, standing=False) == 1.0 - MAX_PACE_CHANGE
    assert next_pace(0.5, 1.0, standing=False) == 0.5 + MAX_PACE_CHANGE
    assert next_pace(0.6, 0.7, standing=False) == 0.7
    assert next_pace(1.0, 0.5, standing=True) == 0.5


def test_an_evader_is_as_calm_as_leaves_room() -> None:
    """A slow pursuer is evaded at a low pace, a fast one is not."""
    strategy = Evasion(trigger="time", calmest=0.5)

    def pace(speed: float, near: float = 0.05) -> float:
        away = strategy.clearance + speed * (strategy.contact_time - near)
        known = Knowledge(
            1.0, 0.0, away, LIMITS, velocity=(-speed, 0.0), moving=True
        )
        return strategy.decide(known, strategy.begin())[0].pace

    assert pace(1.4) == pace(1.0, near=1.5) == 1.0
    paces = [pace(speed) for speed in (0.1, 0.3, 0.8, 1.4)]
    assert paces == sorted(paces) and paces[0] < 1.0
    always = replace(strategy, calmest=1.0)
    known = Knowledge(1.0, 0.0, 1.0, LIMITS, velocity=(-0.1, 0.0), moving=True)
    assert always.decide(known, always.begin())[0].pace == 1.0
    assert abs(always.decide(known, always.begin())[0].heading) <= pi / 2
