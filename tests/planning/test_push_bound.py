"""Test the push bound of the pendulum, against linear programs too."""

from math import exp, pi

import pytest

from push_linear_program import brute_force, corners_of
from reference_plans import plan_of
from stepaside.core.convex import half_planes
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.maneuver import steady_plan
from stepaside.planning.push_bound import (
    FootReach,
    held_regions,
    push_bound,
)

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
    [region] = held_regions(plan, landed, REACH)
    normals, offsets = half_planes(region)
    room = offsets - corners_of(plan, 1, 2) @ normals.T
    assert room.min() > -1e-12
    assert len(held_regions(plan, 0.1, REACH)) == 2


@pytest.mark.parametrize(
    ("kind", "time", "direction", "reach", "lasts"),
    [
        ("walk", 0.0, 0.0, SHORT, 0.0),
        ("walk", 0.05, pi, SHORT, 0.0),
        ("walk", 0.4, pi / 2.0, REACH, 0.0),  # inward
        ("walk", 0.2, -1.0, REACH, 0.1),
        ("walk", 0.41, 2.2, REACH, 0.1),  # the push lasts past the landing
        ("walk", 0.47, 0.4, SHORT, 0.1),
        ("walk", 0.52, -2.0, SHORT, 0.0),
        ("start", 0.3, 0.0, REACH, 0.0),
        ("start", 0.7, 1.2, SHORT, 0.1),
    ],
)
def test_bound_is_the_best_of_all_linear_programs(
    kind: str,
    time: float,
    direction: float,
    reach: FootReach,
    lasts: float,
) -> None:
    """Sampled ZMPs, and one landing at a time."""
    plan = walking(bearing=0.3) if kind == "walk" else plan_of(kind)
    bound = push_bound(plan, time, direction, MASS, reach, lasts=lasts)
    brute = brute_force(
        plan, time, direction, MASS, reach, lasts=lasts, number=3
    )
    assert bound == pytest.approx(brute, rel=1e-6)
