"""Test a pursuer that a hand steers."""

from math import radians

import pytest

from stepaside.planning import Direction
from stepaside.strategies.driving import Driven


@pytest.mark.parametrize("turn", [-1.0, -0.5, 0.0, 1.0])
def test_it_heads_where_the_hand_points_whatever_it_sees(turn: float) -> None:
    """Positive turns to the left, as every angle here; 50 degrees at most."""
    role = Driven(turn=turn)
    for bearing in (-1.0, 2.0):
        assert role.desired_heading(bearing) == pytest.approx(
            radians(50.0 * turn)
        )


def test_it_walks_while_the_hand_lets_it() -> None:
    role = Driven()
    assert not role.is_triggered(0.1)
    role.going = True
    assert role.is_triggered(10.0)


def test_it_walks_forward_straight_ahead_and_turns_by_8() -> None:
    role = Driven()
    assert role.direction is Direction.FORWARD
    assert role.desired_heading(1.0) == 0.0
    assert not role.saturated
