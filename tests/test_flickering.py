"""An evader whose map flickers keeps its plan, and dares a little more."""

from typing import Any

import pytest

from made_up_robot import GAIT
from stepaside.control.clearance.surroundings import GivenRoom, SeenRoom
from stepaside.control.deciding import Decisions
from stepaside.perception.floor_map import CELL, FloorMap
from stepaside.poses import Pose
from stepaside.rooms import Room, box
from stepaside.sensing.measurement import Sighting
from stepaside.steps import search
from stepaside.strategies import Knowledge, Limits
from stepaside.strategies.look_ahead import PENALTY, LookAhead

LIMITS = Limits(GAIT.speed, GAIT.gain, GAIT.stride, GAIT.step_duration)


def known(time: float, gap: float, blur: float) -> Knowledge:
    """A pursuer ahead, and a wall behind at a distance in [m]."""
    wall = box(-gap - 0.05, 0.1, 0.1, 3.0)
    return Knowledge(
        time, 0.1, 0.6, LIMITS, moving=True, obstacles=(wall,), blur=blur
    )


def turned(blur: float) -> int:
    """How often its mind changes while the wall seems to jump by 4 cm."""
    strategy, changes, last = LookAhead(), 0, 0.0
    memory: Any = strategy.begin()
    for step in range(12):
        gap = 0.40 + 0.04 * (step % 2)
        knowledge = known(step * GAIT.step_duration, gap, blur)
        intent, memory = strategy.decide(knowledge, memory)
        changes += step > 0 and abs(intent.heading - last) > 1.0
        last = intent.heading
    return changes


def test_a_mind_changes_less_where_a_map_may_be_off() -> None:
    assert turned(CELL) < turned(0.0)


@pytest.mark.parametrize(
    ("blur", "penalty", "gain"),
    [(0.0, PENALTY, 1e-6), (0.005, PENALTY, 0.005), (CELL, 10.0, CELL)],
)
def test_a_map_that_is_exact_is_taken_at_its_word(
    monkeypatch: pytest.MonkeyPatch, blur: float, penalty: float, gain: float
) -> None:
    told: list[Any] = []
    looked = search.look_ahead

    def look(*given: Any, **named: Any) -> Any:
        told.append(given[4])
        return looked(*given, **named)

    monkeypatch.setattr(search, "look_ahead", look)
    strategy = LookAhead()
    strategy.decide(known(0.0, 1.0, blur), strategy.begin())
    assert told[0].penalty == pytest.approx(penalty)
    assert told[0].gain == pytest.approx(gain)


def test_strategies_are_told_how_far_off_a_map_may_be() -> None:
    given = GivenRoom(Room(), Pose(0.0, 0.0, 0.0))
    seen = SeenRoom(FloorMap(), unseen_is_free=False)
    for around, blur in ((None, 0.0), (given, 0.0), (seen, CELL)):
        decisions = Decisions(LookAhead(), GAIT, 0.02, around)
        decisions.headings.note(0.0, 0.0)
        decisions.templates.note(0.0, Pose(0.0, 0.0, 0.0))
        told = decisions._knowledge(0.0, Sighting(0.0, 0.0, 1.0), moving=True)
        assert told.blur == blur
