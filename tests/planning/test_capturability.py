"""Test the push bound of the pendulum."""

from dataclasses import replace
from math import exp, inf, nan, pi

import numpy as np
import pytest

from push_linear_program import corners_of
from reference_plans import plan_of
from stepaside.core.convex import half_planes
from stepaside.core.errors import PlanError
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.capturability import (
    FootReach,
    held_regions,
    push_bound,
)
from stepaside.planning.steady_gait import steady_plan

MASS = 5.305  # [kg], of the NAO
GAIT = GaitSettings()
REACH = FootReach()
SHORT = FootReach(0.08, 0.08, 0.02, 0.012)  # of the feedback
OUTWARD = {Foot.LEFT: -pi / 2.0, Foot.RIGHT: pi / 2.0}


def walking(
    first_foot: Foot = Foot.LEFT,
    bearing: float = 0.0,
    gait: GaitSettings | None = None,
) -> ManeuverPlan:
    """Plan of a walk under way."""
    return steady_plan(
        ManeuverPlanner(gait or GAIT),
        bearing,
        Direction.FORWARD,
        first_foot=first_foot,
    )


def test_the_outward_bound_is_that_of_the_sole() -> None:
    plan = walking()
    dcm = plan.sample([0.0]).dcm[0]
    expected = MASS * GAIT.eta * (GAIT.sole.outer + dcm[1])
    bound = push_bound(plan, 0.0, OUTWARD[Foot.LEFT], MASS, REACH)
    assert bound == pytest.approx(expected, rel=1e-9)


def test_inward_bound_is_the_farthest_foot_and_the_inner_edge_until_then() -> (
    None
):
    """At the landing the whole weight can be on the far edge of the foot."""
    plan, time = walking(), 0.4
    rest = GAIT.single_support - time
    fade = exp(-GAIT.eta * rest)
    far = GAIT.foot_spacing + REACH.outward + GAIT.sole.outer
    held = fade * far + (1.0 - fade) * GAIT.sole.inner
    dcm = plan.sample([time]).dcm[0]
    expected = MASS * GAIT.eta * (held - dcm[1])
    bound = push_bound(plan, time, pi / 2.0, MASS, REACH)
    assert bound == pytest.approx(expected, rel=1e-9)


def test_bound_in_a_starting_double_support_waits_for_the_lift() -> None:
    """Forward: both feet until they part, one until the landing, then both."""
    plan, time = plan_of("start", 0.0), 0.3
    sole, eta = GAIT.sole, GAIT.eta
    fade = exp(-eta * (GAIT.start_support + GAIT.single_support - time))
    held = fade * (REACH.forward + sole.front) + (1.0 - fade) * sole.front
    dcm = plan.sample([time]).dcm[0]
    expected = MASS * eta * (held - dcm[0])
    bound = push_bound(plan, time, 0.0, MASS, REACH)
    assert bound == pytest.approx(expected, rel=1e-9)
    # To the other side of the foot that will stand, both feet hold more.
    side = push_bound(plan, time, pi / 2.0, MASS, REACH)
    alone = MASS * eta * (sole.inner - dcm[1])
    assert side > 2.0 * alone


def test_the_gap_between_the_soles_limits_the_bound() -> None:
    """Ahead and outward a foot would land across, if the gap let it."""
    plan, direction = walking(), -pi / 4.0
    bounds = [
        push_bound(plan, 0.4, direction, MASS, FootReach(gap=gap))
        for gap in (0.0, 0.012, 0.05)
    ]
    assert bounds[0] > bounds[1] + 0.02 and bounds[1] > bounds[2] + 0.02


@pytest.mark.parametrize("time", [0.0, 0.2, 0.42, 0.45, 0.54])
@pytest.mark.parametrize("direction", np.linspace(-3.0, 3.0, 5).tolist())
def test_bound_grows_with_the_sole_the_reach_and_the_steps(
    time: float, direction: float
) -> None:
    plan = walking(bearing=0.5)
    sole = replace(GAIT.sole, back=-0.06, front=0.105, outer=0.052)
    larger = walking(bearing=0.5, gait=replace(GAIT, sole=sole))
    bound = push_bound(plan, time, direction, MASS, REACH)
    assert push_bound(larger, time, direction, MASS, REACH) > bound
    wide = FootReach(0.2, 0.2, 0.2, 0.0)
    assert push_bound(plan, time, direction, MASS, wide) >= bound
    by_steps = [
        push_bound(plan, time, direction, MASS, REACH, steps=n)
        for n in (0, 1, 2, 3)
    ]
    assert by_steps == sorted(by_steps)


@pytest.mark.parametrize("time", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("direction", [0.0, 1.0, 2.5, -2.0])
def test_bound_is_the_same_in_the_mirror(
    time: float, direction: float
) -> None:
    left = push_bound(walking(Foot.LEFT, 0.4), time, direction, MASS, REACH)
    right = push_bound(
        walking(Foot.RIGHT, -0.4), time, -direction, MASS, REACH
    )
    assert left == pytest.approx(right, rel=1e-9)
    assert left > 0.0


def test_a_push_that_lasts_is_an_impulse_and_a_factor() -> None:
    """(1 - e^-h) / h of it counts, for the DCM grows meanwhile."""
    plan = walking()
    one = push_bound(plan, 0.1, 0.3, MASS, REACH)
    h = GAIT.eta * 0.1
    lasting = push_bound(plan, 0.1, 0.3, MASS, REACH, lasts=0.1)
    assert lasting == pytest.approx(one * h / (1.0 - exp(-h)), rel=1e-12)
    short = push_bound(plan, 0.1, 0.3, MASS, REACH, lasts=1e-9)
    assert short == pytest.approx(one, rel=1e-6)


def test_a_lost_state_has_a_zero_bound_in_the_recovering_direction() -> None:
    """Every smaller push has to be held, too."""
    plan = ManeuverPlanner(GAIT).plan(
        0.0,
        Direction.FORWARD,
        first_foot=Foot.LEFT,
        state=CenterState((0.0, -0.2), (0.0, 0.0)),
    )
    assert push_bound(plan, 0.0, pi / 2.0, MASS, REACH) == 0.0


def test_a_halt_is_held_by_its_two_feet_and_no_third_step() -> None:
    plan = plan_of("halt")
    landed = GAIT.single_support + 0.05
    [region] = held_regions(plan, landed, REACH, 1)
    normals, offsets = half_planes(region)
    room = offsets - corners_of(plan, 1, 2) @ normals.T
    assert room.min() > -1e-12
    assert len(held_regions(plan, 0.1, REACH, 1)) == 2


def test_more_footsteps_hold_hardly_more() -> None:
    """Within the reach of the feedback: under 5 %, however many follow."""
    plan = walking()
    for time in (0.0, 0.2, 0.4):
        for direction in np.linspace(-pi, pi, 8).tolist():
            one, many = (
                push_bound(plan, time, direction, MASS, SHORT, steps=n)
                for n in (1, 8)
            )
            assert one <= many < 1.05 * one


def test_a_push_later_in_the_step_may_be_harder_forward() -> None:
    plan = walking()
    bounds = [push_bound(plan, t, 0.0, MASS, REACH) for t in (0.0, 0.2, 0.4)]
    assert bounds == sorted(bounds)


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"time": -0.1}, "time"),
        ({"time": nan}, "time"),
        ({"direction": nan}, "direction"),
        ({"mass": 0.0}, "mass"),
        ({"lasts": -0.1}, "lasts"),
        ({"lasts": inf}, "lasts"),
        ({"steps": -1}, "steps"),
        ({"reach": FootReach(gap=-0.01)}, "reach.gap"),
    ],
)
def test_an_invalid_push_is_refused(
    change: dict[str, object], match: str
) -> None:
    asked: dict[str, object] = {
        "plan": walking(),
        "time": 0.0,
        "direction": 0.0,
        "mass": MASS,
        "reach": REACH,
    }
    with pytest.raises(PlanError, match=match):
        push_bound(**(asked | change))  # type: ignore[arg-type]
