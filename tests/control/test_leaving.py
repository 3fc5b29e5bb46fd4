"""Test the escape from within the margin of an inaccurate map."""

from typing import Any

import pytest

from fake_robot import GAIT
from stepaside.arena import Box, ObstacleSet
from stepaside.core.poses import Pose
from stepaside.locomotion.guard import GAINED, Guard, ManeuverClearance
from stepaside.locomotion.locomotion import GuardDecision
from stepaside.planning import (
    Direction,
    Foot,
    ManeuverPlan,
    ManeuverPlanner,
    TemplateDrive,
)
from stepaside.robots.description import load_robot
from stepaside.sim.outline_measurement import measure_outline
from stepaside.strategies import Intent

MARGIN = 0.02
PLANNER = ManeuverPlanner(GAIT)
NAO = measure_outline(load_robot("nao"), GAIT)
SUPPORT = Pose(0.0, -0.05, 0.0)


def plan_for(choice: GuardDecision) -> ManeuverPlan:
    return PLANNER.plan(
        choice.intent.heading,
        Direction(1 - 2 * choice.back),
        first_foot=Foot.LEFT,
        standing=True,
        drive=TemplateDrive(speed_factor=choice.intent.speed_factor),
    )


def beside(gap: float, around: Any, *, out: bool) -> GuardDecision | None:
    """Decision beside a wall on the left, at a distance in [m]."""
    guard = Guard(around, NAO, PLANNER, margin=MARGIN)
    half = float(NAO.trunk[:, 1].max())
    around.solids = ObstacleSet((Box(0.0, half + gap + 0.5, 9.0, 1.0),))
    clearance = guard.evaluate(plan_for(GuardDecision(Intent(0.0))), SUPPORT)
    assert clearance.now == pytest.approx(gap, abs=1e-9)
    if out:
        return guard.choose_escape(Intent(0.6), plan_for, SUPPORT)
    return guard.choose(Intent(0.6), plan_for, SUPPORT, standing=True)


@pytest.mark.parametrize(
    ("clearance", "escapes"),
    [
        (ManeuverClearance(0.01, 0.01, 0.011), True),
        (ManeuverClearance(0.01, -0.039, 0.011), True),
        (ManeuverClearance(0.01, -0.041, 0.011), False),  # too near on the way
        (ManeuverClearance(0.01, 0.01, 0.01), False),  # no farther
        (ManeuverClearance(0.01, 0.01, 0.009), False),
        (
            ManeuverClearance(0.02, 0.0, 0.1),
            False,
        ),  # where it stands is room enough
    ],
)
def test_an_escape_ends_farther_and_hardly_approaches(
    clearance: ManeuverClearance, escapes: bool
) -> None:
    assert clearance.escapes(MARGIN, 0.05) is escapes
    strict = escapes and clearance.least >= clearance.now
    assert clearance.escapes(MARGIN, 0.0) is strict


def test_an_escape_gains_clearance_or_ends_at_the_margin() -> None:
    """Otherwise the robot would shuffle indefinitely."""
    for last, escapes in ((0.013, False), (0.0141, True)):
        assert (
            ManeuverClearance(0.01, 0.0, last).escapes(MARGIN, 0.05, GAINED)
            is escapes
        )
    assert ManeuverClearance(0.018, 0.0, 0.0201).escapes(MARGIN, 0.05, GAINED)
    assert GAINED == 0.004
