"""Test the history of states for late sightings."""

import pytest

from stepaside.control.state_history import DURATION, StateHistory

TICK = 0.02


def filled(ticks: int) -> StateHistory[float]:
    """Memory of a torso that turns by 1 rad/s."""
    memory: StateHistory[float] = StateHistory(TICK)
    for i in range(ticks):
        memory.note(TICK * i, TICK * i)
    return memory


def test_a_value_is_that_of_the_last_tick_before_a_time() -> None:
    memory = filled(50)
    assert memory.at(0.40) == pytest.approx(0.40)
    assert memory.at(0.40 + 0.99 * TICK) == pytest.approx(0.40)
    assert memory.at(0.40 - 0.01 * TICK) == pytest.approx(0.38)


def test_a_tick_is_found_despite_rounding() -> None:
    memory = filled(50)
    assert memory.at(0.40 - 1e-12) == pytest.approx(0.40)


def test_now_and_later_give_the_newest() -> None:
    assert filled(50).at(5.0) == pytest.approx(0.98)


def test_before_memory_begins_the_oldest_counts() -> None:
    assert filled(50).at(-1.0) == 0.0


def test_history_covers_two_seconds() -> None:
    memory = filled(500)
    newest = 499 * TICK
    assert memory.at(newest - 1.9) == pytest.approx(newest - 1.9)
    oldest = newest - DURATION + TICK
    assert memory.at(0.0) == pytest.approx(oldest)
    assert DURATION == 2.0


def test_a_slow_clock_keeps_at_least_one() -> None:
    memory: StateHistory[float] = StateHistory(10.0)
    memory.note(0.0, 1.0)
    memory.note(10.0, 2.0)
    assert memory.at(0.0) == 2.0
