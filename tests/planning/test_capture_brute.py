"""Test the push bound against linear programs and random controllers."""

from dataclasses import replace
from math import cos, exp, expm1, pi, sin
from typing import Literal

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from push_linear_program import (
    brute_force,
    corners_of,
    interval,
    landing,
    two_steps,
)
from reference_plans import plan_of
from stepaside.core.poses import Array
from stepaside.planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.planning.capturability import (
    FootReach,
    push_bound,
    ray_interval,
)
from stepaside.planning.steady_gait import steady_plan

MASS = 5.305  # [kg], of the NAO
GAIT = GaitSettings()
REACH = FootReach()
SHORT = FootReach(0.08, 0.08, 0.02, 0.012)  # of the feedback


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


@pytest.mark.parametrize("profile", ["linear", "cubic"])
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
    profile: Literal["linear", "cubic"],
) -> None:
    """Made from other words; ``tools/benchmarks/push_bound.py`` tries 60."""
    gait = replace(GAIT, zmp_profile=profile)
    plan = (
        walking(bearing=0.3, gait=gait)
        if kind == "walk"
        else plan_of(kind, gait=gait)
    )
    bound = push_bound(plan, time, direction, MASS, reach, lasts=lasts)
    brute = brute_force(
        plan, time, direction, MASS, reach, lasts=lasts, number=3
    )
    assert bound == pytest.approx(brute, rel=1e-6)


def test_no_random_controller_withstands_more_than_the_bound() -> None:
    """Simulated, with a ZMP that jumps from corner to corner as it likes."""
    plan, time, lasts = walking(), 0.15, 0.1
    generator, tick = np.random.default_rng(4), 0.005
    eta, single = GAIT.eta, GAIT.single_support
    grow = exp(eta * tick)
    best = 0.0
    for direction in np.linspace(-pi, pi, 9).tolist():
        heading = np.array([cos(direction), sin(direction)])
        bound = push_bound(plan, time, direction, MASS, SHORT, lasts=lasts)
        for _ in range(40):
            x = generator.choice([-SHORT.backward, 0.0, SHORT.forward])
            near = 2.0 * GAIT.sole.inner + SHORT.gap
            far = GAIT.foot_spacing + SHORT.outward
            y = generator.choice([near, far])
            old = corners_of(plan, 1)
            both = np.concatenate([old, landing(plan, 1, float(x), float(y))])
            # Half of them push against the push, the others do anything.
            favoured = old[np.argmax(old @ heading)]
            dcm, moved = plan.sample([time]).dcm[0], 0.0
            for k in range(round((single - time) / tick)):
                corner = favoured
                if generator.random() < generator.choice([0.0, 0.5]):
                    corner = old[generator.integers(4)]
                dcm = corner + grow * (dcm - corner)
                force = 1.0 / (lasts * MASS * eta) if k * tick < lasts else 0.0
                moved = grow * moved + force * expm1(eta * tick) / eta
            # DCM = dcm + J heading moved has to be inside what the feet hold.
            held = reachable(dcm, heading, both) / moved
            best = max(best, held / bound)
            assert held <= bound * (1.0 + 1e-9)
    assert best > 0.9  # and some come near


def reachable(start: Array, heading: Array, corners: Array) -> float:
    """Distance at which a ray leaves a hull of corners; 0 if it misses."""
    hull = corners[ConvexHull(corners).vertices]
    return ray_interval(start, heading, hull)[1]


@pytest.mark.parametrize(
    ("time", "direction", "reach"),
    [(0.1, 0.3, SHORT), (0.3, 3.0, SHORT), (0.4, -0.3, REACH)],
)
def test_two_footsteps_match_linear_programs(
    time: float, direction: float, reach: FootReach
) -> None:
    plan = walking(bearing=0.2)
    found = [
        interval(plan, time, direction, MASS, supports, 0.0)
        for supports in two_steps(plan, time, reach)
    ]
    brute = max(pair[1] for pair in found if pair is not None)
    bounds = [
        push_bound(plan, time, direction, MASS, reach, steps=n) for n in (1, 2)
    ]
    assert bounds[1] == pytest.approx(brute, rel=1e-6)
    assert bounds[1] > 1.001 * bounds[0]
