"""Test decisions of the strategies (paper, Sec. II)."""

from copy import deepcopy
from dataclasses import replace
from math import pi, radians
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.core.errors import ConfigurationError, PlanError
from stepaside.strategies import (
    Evasion,
    EvasionMemory,
    Intent,
    Knowledge,
    Limits,
    Pursuit,
    StandStill,
    Strategy,
    Walk,
)

LIMITS = Limits(0.1, 0.2, 0.04, 0.547)
ALL: list[Strategy] = [
    Pursuit(),
    Evasion(),
    Evasion(angle=1.0, saturated=True, release_distance=1.1),
    Walk(0.3),
    StandStill(),
]
BEARINGS = st.floats(-pi, pi)
DISTANCES = st.floats(0.1, 3.0)


def known(bearing: float = 0.0, distance: float = 0.5) -> Knowledge:
    """Knowledge of a player at a bearing and a distance."""
    return Knowledge(1.0, bearing, distance, LIMITS)


def heading(strategy: Strategy, bearing: float) -> float:
    """Return the heading of a player at its first sighting nearby."""
    return strategy.decide(known(bearing), strategy.begin())[0].heading


def test_a_constant_walk_ignores_the_opponent() -> None:
    walk = Walk(-0.3, speed_factor=0.5)
    for bearing in (1.0, -1.0):
        assert walk.decide(known(bearing, 9.0), None)[0] == Intent(-0.3, 0.5)
    assert heading(Walk(), 1.0) == 0.0
    with pytest.raises(PlanError, match="speed_factor"):
        Walk(speed_factor=1.5)


def test_evader_of_the_paper_moves_aside_from_0_8_m_on() -> None:
    """Sec. IV: the safety area has a radius of 0.8 m and has no end."""
    evader = Evasion()
    intent, memory = evader.decide(known(0.1, 0.801), evader.begin())
    assert not intent.walks and memory == EvasionMemory(False, 0)
    intent, memory = evader.decide(known(0.1, 0.799), memory)
    assert intent.heading == pytest.approx(0.1 - pi / 2)
    assert intent == Intent(intent.heading)
    assert memory == EvasionMemory(True, -1)
    intent, memory = evader.decide(known(0.1, 1e6), memory)
    assert intent.walks and memory == EvasionMemory(True, -1)
    assert evader.side_hysteresis == pytest.approx(radians(20.0))


@given(st.floats(0.01, 3.1), st.floats(0.0, pi))
def test_rule_is_the_same_on_both_sides(bearing: float, angle: float) -> None:
    evader = Evasion(angle=angle)
    assert heading(evader, bearing) == -heading(evader, -bearing)


def test_noise_about_straight_ahead_does_not_flip_the_side() -> None:
    evader = Evasion()
    first, memory = evader.decide(known(0.02), evader.begin())
    second, memory = evader.decide(known(-0.02), memory)
    assert second.heading == pytest.approx(first.heading, abs=0.05)
    flipped, memory = evader.decide(known(radians(-40.0)), memory)
    assert flipped.heading == pytest.approx(radians(50.0))
    assert memory.side == 1


def test_evasion_latches_and_chooses_its_side_anew_after_a_release() -> None:
    """Kept, it would send the evader to the wrong side of a new pursuer."""
    evader = Evasion(safety_radius=0.8, release_distance=1.2)
    memory = evader.begin()
    sides = []
    for distance in (1.0, 0.79, 1.0, 1.19, 1.21, 1.0):
        intent, memory = evader.decide(known(0.1, distance), memory)
        assert intent.walks is memory.evading
        sides.append(memory.side)
    assert sides == [0, -1, -1, -1, 0, 0]
    intent, memory = evader.decide(known(radians(-10.0), 0.7), memory)
    assert intent.heading == pytest.approx(radians(80.0))
    assert memory.side == 1


@given(BEARINGS, BEARINGS, st.floats(0.0, pi))
def test_desired_heading_is_an_angle_within_half_a_turn(
    first: float, then: float, angle: float
) -> None:
    """Also when the latched side is not that of the bearing."""
    evader = Evasion(angle=angle)
    _, memory = evader.decide(known(first), evader.begin())
    intent, _ = evader.decide(known(then), memory)
    assert abs(intent.heading) <= pi


@pytest.mark.parametrize("strategy", ALL, ids=repr)
@given(st.lists(st.tuples(BEARINGS, DISTANCES), min_size=1, max_size=6))
def test_strategies_are_pure(
    strategy: Strategy, seen: list[tuple[float, float]]
) -> None:
    """The same knowledge and memory: the same answer, and no change."""
    before = deepcopy(strategy)
    memory: Any = strategy.begin()
    for bearing, distance in seen:
        knowledge = known(bearing, distance)
        given = deepcopy((knowledge, memory))
        answer = strategy.decide(knowledge, memory)
        assert strategy.decide(knowledge, memory) == answer
        assert (knowledge, memory) == given
        memory = answer[1]
    assert strategy == before
    assert hash(memory) == hash(deepcopy(memory))


@pytest.mark.parametrize("strategy", ALL[:3], ids=repr)
@given(st.lists(st.tuples(BEARINGS, DISTANCES), min_size=1, max_size=6))
def test_mirrored_knowledge_gives_the_mirrored_intent(
    strategy: Strategy, seen: list[tuple[float, float]]
) -> None:
    memory: Any = strategy.begin()
    mirrored: Any = strategy.begin()
    for bearing, distance in seen:
        if bearing == 0.0:
            return  # both normals lie alike, (5) chooses one
        intent, memory = strategy.decide(known(bearing, distance), memory)
        other, mirrored = strategy.decide(known(-bearing, distance), mirrored)
        assert other == replace(intent, heading=-intent.heading)


@pytest.mark.parametrize(
    "bad", [{"release_distance": 0.5}, {"release_distance": 0.8}]
)
def test_impossible_evasion_is_refused(bad: dict[str, float]) -> None:
    with pytest.raises(ConfigurationError, match=next(iter(bad))):
        Evasion(**bad)  # type: ignore[arg-type]
