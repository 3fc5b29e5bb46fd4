"""Test the relative motion against two unicycles on a floor."""

import numpy as np
import pytest

from stepaside.core.poses import Pose
from stepaside.theory.unicycle.game_parameters import flat_parameters
from stepaside.theory.unicycle.piecewise_dynamics import (
    Branch,
    Mode,
    SmoothPiece,
    piece_of,
)
from stepaside.theory.unicycle.relative_coordinates import RelativeStart
from stepaside.theory.unicycle.relative_motion import (
    RelativeState,
    derivative,
    geometry_of,
    geometry_of_arrays,
    recomputed_geometry,
    rk4,
)
from stepaside.theory.unicycle.sampled_game import drive_along_arc
from stepaside.theory.unicycle.unicycle_game import make_game

RULES = flat_parameters(make_game(1.2, 0.9, 0.5, 0.7, 1.1), 0.1)
HERE = RelativeState(1.4, 0.6, -0.8)


@pytest.mark.parametrize(
    ("constant", "slope"), [(0.0, 0.0), (0.3, 0.0), (-0.2, 0.7)]
)
def test_rates_are_those_of_two_unicycles_on_a_floor(
    constant: float, slope: float
) -> None:
    """One drives forward, one backward; both turn as their laws say."""
    state, short = HERE, 1e-5
    piece = SmoothPiece(-9.0, 9.0, constant, slope, 1.0)
    found = derivative(state, geometry_of(state, RULES), piece, RULES)
    pursuer = Pose(0.3, -0.2, 0.9)
    evader = RelativeStart(*state).evader_pose(pursuer)
    turns = 0.5 * state.a, constant + slope * state.psi
    ends = [
        RelativeStart.from_world(
            drive_along_arc(pursuer, 1.2, turns[0], time),
            drive_along_arc(evader, -0.9, turns[1], time),
        ).wrapped()
        for time in (short, -short)
    ]
    expected = (np.array(ends[0]) - ends[1]) / (2.0 * short)
    assert found == pytest.approx(tuple(expected), abs=1e-9)


def test_sliding_evader_turns_with_the_line_of_sight() -> None:
    piece = piece_of(Mode(1, Branch.SLIDING), RULES)
    view = geometry_of(HERE, RULES)
    assert view.sight != 0.0
    assert derivative(HERE, view, piece, RULES).psi == 0.0


def test_error_of_a_step_falls_by_the_fifth_power_of_its_length() -> None:
    """Against a thousand short steps: fourth order over a given time."""
    piece = piece_of(Mode(1, Branch.PROPORTIONAL), RULES)

    def advance(length: float, count: int) -> np.ndarray:
        state = HERE
        for _ in range(count):
            view = geometry_of(state, RULES)
            state = rk4(
                recomputed_geometry, state, view, length / count, piece, RULES
            )
        return np.array(state)

    errors = [
        np.abs(advance(length, 1) - advance(length, 1000)).max()
        for length in (0.2, 0.1, 0.05)
    ]
    assert errors[0] / errors[1] == pytest.approx(32.0, rel=0.25)
    assert errors[1] / errors[2] == pytest.approx(32.0, rel=0.15)


def test_geometry_of_arrays_equals_that_of_numbers() -> None:
    states = np.random.default_rng(3).uniform(0.2, 3.0, (3, 7))
    many = np.array(geometry_of_arrays(RelativeState(*states), RULES))
    ones = [
        geometry_of(RelativeState(*one), RULES) for one in states.T.tolist()
    ]
    np.testing.assert_allclose(many.T, ones, rtol=0.0, atol=1e-14)
