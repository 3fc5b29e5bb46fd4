"""Test the steps that are cut where something happens."""

from math import pi, sin

import numpy as np
import pytest

from stepaside.theory.unicycle.event_location import (
    Event,
    StateView,
    event_located_step,
    margin,
    time_of,
)
from stepaside.theory.unicycle.game_parameters import (
    FlatParameters,
    flat_parameters,
)
from stepaside.theory.unicycle.piecewise_dynamics import (
    Branch,
    Mode,
    SmoothPiece,
    piece_of,
)
from stepaside.theory.unicycle.relative_motion import (
    RelativeState,
    geometry_of,
)
from stepaside.theory.unicycle.unicycle_game import make_game

ONWARD = Mode(1, Branch.PROPORTIONAL)


def driving_past(capture_distance: float) -> FlatParameters:
    """A pursuer drives straight on, and the evader stands still."""
    made = flat_parameters(
        make_game(1.0, 1.0, 1.0, 1.0, 0.0), capture_distance
    )
    return made._replace(evader_speed=0.0, pursuer_gain=0.0, evader_gain=0.0)


def test_margins_fall_to_zero_at_their_events() -> None:
    rules = flat_parameters(make_game(1.2, 0.9, 0.5, 0.6), 0.7)
    state, piece = (
        RelativeState(2.0, -0.4, -0.3),
        SmoothPiece(-1.0, 0.5, 0.0, 0.6, 1.0),
    )
    rate = (1.2 * sin(-0.4) - 0.9 * sin(-0.3)) / 2.0
    closing = 1.2 * np.cos(0.4) - 0.9 * np.cos(-0.3)
    expected = {
        Event.WRAP: pi - 0.4,
        Event.LOW: 0.7,
        Event.HIGH: 0.8,
        Event.RELEASE: 0.6 - abs(rate),
        Event.CLOSEST: closing,
        Event.CAPTURE: 1.3,
    }
    now = StateView(state, geometry_of(state, rules))
    got = {event: margin(event, now, piece, rules) for event in expected}
    assert got == pytest.approx(expected)


def test_step_returns_the_closest_approach_and_its_time() -> None:
    """A pursuer drives straight past an evader that stands still."""
    a, r = np.arctan2(0.3, 0.5), np.hypot(0.3, 0.5)
    past, apart = RelativeState(r, a, -a), RelativeState(r, pi - a, -a)
    step = event_located_step(past, ONWARD, 2.0, driving_past(0.01))
    assert step[2:] == pytest.approx((0.3, 0.5, -1.0))
    assert step.state.r == pytest.approx(np.hypot(0.3, 1.5))
    step = event_located_step(apart, ONWARD, 0.5, driving_past(0.01))
    assert step[2:] == pytest.approx((r, 0.0, -1.0))
    step = event_located_step(past, ONWARD, 2.0, driving_past(0.5))
    when = 0.5 - np.sqrt(0.5**2 - 0.3**2)
    assert step[2:] == pytest.approx((0.5, when, when))


def test_return_to_an_edge_is_located() -> None:
    """The line of sight outruns the evader for some milliseconds only."""
    rules = flat_parameters(
        make_game(1.0, 1.0, 0.5, 0.5, law="saturated"), 0.2
    )
    state = RelativeState(1.2787314540990418, -2.7776696801482905, -0.5 * pi)
    left = Mode(1, Branch.LEFT)
    assert 0.5 < geometry_of(state, rules).sight < 0.51
    piece = piece_of(left, rules)
    now = StateView(state, geometry_of(state, rules))
    for length in (0.007, 0.03, 0.1):
        time = time_of(Event.LOW, now, length, piece, rules)
        assert 0.003 < time < 0.005
    step = event_located_step(state, left, 0.01, rules)
    assert step.mode == (1, Branch.SLIDING)
    assert step.state.psi == -0.5 * pi
