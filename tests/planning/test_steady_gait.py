"""Test the periodic state of a steady walk."""

import numpy as np
import pytest

from reference_plans import plan_of
from stepaside.planning import Direction, Foot, GaitSettings, ManeuverPlanner
from stepaside.planning.maneuver import landing_state
from stepaside.planning.push_bound import steady_plan

GAIT = GaitSettings()


@pytest.mark.parametrize("bearing", [0.0, 0.8])
@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("foot", Foot)
def test_steady_state_recurs(
    bearing: float, direction: Direction, foot: Foot
) -> None:
    """A long walk from standing ends in it, whatever it began with."""
    planner = ManeuverPlanner(GAIT)
    plan = steady_plan(planner, bearing, direction, first_foot=foot)
    walked = plan_of("walk", bearing, foot=foot.other, direction=direction)
    for _ in range(14):
        walked = planner.plan(
            bearing,
            direction,
            first_foot=walked.first_foot.other,
            state=landing_state(walked),
        )
    assert walked.first_foot is foot
    np.testing.assert_allclose(walked.inputs, plan.inputs, atol=1e-9)


def test_the_periodic_state_of_a_straight_walk() -> None:
    """Not at rest over the foot, which the bound was once taken from."""
    plan = steady_plan(
        ManeuverPlanner(GAIT), 0.0, Direction.FORWARD, first_foot=Foot.LEFT
    )
    dcm = plan.sample([0.0]).dcm[0]
    np.testing.assert_allclose(dcm, [0.0222, 0.0052], atol=5e-5)
