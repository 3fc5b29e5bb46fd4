"""Test past values."""

import pytest

from stepaside.core.history import History


def half_way(one: float, other: float, share: float) -> float:
    return one + share * (other - one)


def filled() -> History[float]:
    history = History[float](1.0)
    for time, value in ((0.0, 5.0), (0.5, 6.0), (1.5, 8.0), (1.0, 7.0)):
        history.note(time, value)
    return history


def test_a_value_holds_until_the_next_one() -> None:
    """Also where an earlier one was noted after it."""
    history = filled()
    assert [history.at(t) for t in (0.5, 0.9, 1.0, 1.4, 9.0)] == [
        *(6.0, 6.0, 7.0, 7.0, 8.0)
    ]
    assert history.latest == 8.0


def test_values_beyond_the_span_are_dropped() -> None:
    assert filled().at(0.0) == 6.0


def test_values_in_between_are_interpolated() -> None:
    history = filled()
    for time, value in ((0.7, 6.4), (1.0, 7.0), (1.25, 7.5), (9.0, 8.0)):
        assert history.at(time, half_way) == pytest.approx(value)


def test_there_is_none_at_first() -> None:
    assert History[float](1.0).latest is None
