"""Who stands where a map leaves no room gets out, if it may be wrong."""

from typing import Any

import numpy as np
import pytest

from made_up_robot import GAIT
from stepaside.control.clearance.guard import Choice, Guard, Passage
from stepaside.control.clearance.solids import Solids
from stepaside.control.clearance.surroundings import GivenRoom, SeenRoom
from stepaside.perception.floor_map import CELL, FloorMap
from stepaside.planning import Direction, Foot, ManeuverPlan, ManeuverPlanner
from stepaside.poses import Pose
from stepaside.robots.description import load_robot
from stepaside.rooms import Room, box
from stepaside.strategies import Intent
from stepaside.world.outline import measure_outline

MARGIN = 0.02
PLANNER = ManeuverPlanner(GAIT)
NAO = measure_outline(load_robot("nao"), GAIT)
SUPPORT = Pose(0.0, -0.05, 0.0)


def plan_for(choice: Choice) -> ManeuverPlan:
    return PLANNER.plan(
        choice.intent.heading,
        Direction(1 - 2 * choice.back),
        first_foot=Foot.LEFT,
        standing=True,
        speed_factor=choice.intent.speed_factor,
    )


def beside(
    gap: float, around: Any, *, standing: bool, loosely: bool = True
) -> Choice | None:
    """What is chosen beside a wall on the left, at a distance in [m]."""
    guard = Guard(around, NAO, PLANNER, margin=MARGIN)
    half = float(NAO.trunk[:, 1].max())
    around.solids = Solids((box(0.0, half + gap + 0.5, 9.0, 1.0),))
    passage = guard.passage(plan_for(Choice(Intent(0.0))), SUPPORT)
    assert passage.now == pytest.approx(gap, abs=1e-9)
    return guard.choose(
        Intent(0.6), plan_for, SUPPORT, standing=standing, loosely=loosely
    )


def given() -> GivenRoom:
    return GivenRoom(Room(obstacles=()), Pose(0.0, 0.0, 0.0))


def seen() -> SeenRoom:
    return SeenRoom(FloorMap(), unseen_is_free=False)


def test_a_step_sways_to_where_a_map_sees_a_wall() -> None:
    """Beside a wall that is known to be there nobody does that."""
    kept = beside(0.3, given(), standing=True, loosely=False)
    assert kept == Choice(Intent(0.6))
    assert beside(0.009, given(), standing=True) is None
    assert beside(0.009, seen(), standing=True, loosely=False) is None
    chosen = beside(0.009, seen(), standing=True)
    assert chosen is not None
    guard = Guard(seen(), NAO, PLANNER, margin=MARGIN)
    guard.surroundings.solids = Solids(  # type: ignore[misc]
        (box(0.0, float(NAO.trunk[:, 1].max()) + 0.509, 9.0, 1.0),)
    )
    passage = guard.passage(plan_for(chosen), SUPPORT)
    assert passage.last > passage.now
    assert passage.least > passage.now - CELL


def test_who_walks_or_has_room_to_stand_takes_no_such_way() -> None:
    assert beside(0.009, seen(), standing=False) is None
    assert beside(0.021, seen(), standing=True) is None


@pytest.mark.parametrize(
    ("passage", "leaves"),
    [
        (Passage(0.01, 0.01, 0.011), True),
        (Passage(0.01, -0.039, 0.011), True),
        (Passage(0.01, -0.041, 0.011), False),  # too near on the way
        (Passage(0.01, 0.01, 0.01), False),  # no farther
        (Passage(0.01, 0.01, 0.009), False),
        (Passage(0.02, 0.0, 0.1), False),  # where it stands is room enough
    ],
)
def test_a_way_out_leads_farther_and_comes_hardly_nearer(
    passage: Passage, leaves: bool
) -> None:
    assert passage.leaves(MARGIN, 0.05) is leaves
    strict = leaves and passage.least >= passage.now
    assert passage.leaves(MARGIN, 0.0) is strict


def test_of_two_ways_out_the_one_that_comes_least_near_is_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(3)
    told: dict[Choice, Passage] = {}

    def passage(_: Guard, plan: Any, support: Pose) -> Passage:
        return told.setdefault(
            plan, Passage(0.01, random.uniform(-0.03, 0.0), 0.02)
        )

    monkeypatch.setattr(Guard, "passage", passage)
    around: Any = seen()
    around.solids = Solids((box(0.0, 1.0, 1.0, 1.0),))
    guard = Guard(around, NAO, PLANNER, margin=MARGIN)
    same: Any = lambda choice: choice  # noqa: E731
    chosen = guard.choose(
        Intent(0.6), same, SUPPORT, standing=True, loosely=True
    )
    assert chosen is not None and len(told) > 3
    assert told[chosen].least == max(p.least for p in told.values())
