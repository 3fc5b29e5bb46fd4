"""Test the chauffeur's game: closed forms, grids and simulated games."""

from functools import partial
from math import asin, cos, pi, sqrt

import numpy as np
import pytest

from played_values import by_table, play, towards
from stepaside.core.errors import PlanError
from stepaside.theory.value import ChauffeurGame, ValueTable, solve_chauffeur
from stepaside.theory.value.chauffeur import guaranteed_distance

RATIO = 0.643
CELLS = 60
SLOW = partial(pytest.param, marks=pytest.mark.slow)


def game_of(ratio: float, radius: float = 1.0) -> ChauffeurGame:
    return ChauffeurGame(1.0, ratio, radius)


GAME = game_of(RATIO)


@pytest.fixture(scope="module")
def table() -> ValueTable:
    return solve_chauffeur(GAME, CELLS)


def test_closed_form_is_continuous_and_has_its_limits() -> None:
    """gamma^2 / 2 for slow evaders; pi / 2 - 1 at the first regime's end."""
    assert guaranteed_distance(0.01) == pytest.approx(0.5e-4, rel=1e-3)
    edge = 0.8975
    low, high = (
        guaranteed_distance(edge - 2e-4),
        guaranteed_distance(edge + 2e-4),
    )
    assert abs(high - low) < 1e-3
    assert guaranteed_distance(1.0) == pytest.approx(0.563, abs=1e-3)


def test_straight_run_against_a_full_turn_grazes_the_capture_circle() -> None:
    """Play barrier points forwards, in coordinates of the floor."""
    capture = 0.15
    line = GAME.barrier(capture)
    assert line is not None
    side = np.arccos(RATIO)
    ends = np.linspace(0.0, _closing_time(capture), len(line) + 2)[1:-1]
    for (ahead, left, _), t in list(zip(line, ends, strict=True))[::6]:
        # The car turns left; the run is normal to the circle of capture.
        run = side + t
        times = np.linspace(0.0, t + 0.3, 4001)
        x = ahead + RATIO * times * cos(run) - np.sin(times)
        y = left + RATIO * times * np.sin(run) - (1.0 - np.cos(times))
        distances = np.hypot(x, y)
        assert distances.min() == pytest.approx(capture, abs=1e-4)
        assert times[distances.argmin()] == pytest.approx(t, abs=0.02)


def _closing_time(capture: float) -> float:
    """Time at which the left half of the barrier meets the axis."""
    t = np.linspace(0.0, asin(RATIO), 20_000)
    s = np.arccos(RATIO)
    side = (capture - RATIO * t) * np.sin(s + t) + 1.0 - np.cos(t)
    return float(t[np.argmax(side <= 0.0)])


@pytest.mark.parametrize("ratio", [0.36, 0.5, 0.643, SLOW(0.8), SLOW(0.95)])
def test_grid_agrees_with_the_closed_form(ratio: float) -> None:
    """In both regimes; the solver knows the formula only as a cap."""
    found = solve_chauffeur(game_of(ratio), CELLS).grid.outside
    assert found == pytest.approx(guaranteed_distance(ratio), rel=0.005)


def test_barrier_of_the_table_is_within_a_third_of_a_cell(
    table: ValueTable,
) -> None:
    for capture in (0.1, 0.15):
        line = GAME.barrier(capture)
        assert line is not None
        off = table.offsets(line, capture)
        off = np.abs(off) / table.grid.spacing
        assert off.max() < 0.35 and off.mean() < 0.06


def test_value_is_no_larger_than_the_guarantee_and_the_distance(
    table: ValueTable,
) -> None:
    assert (table.values <= table.grid.distances(np.inf) + 1e-12).all()
    assert table.values.max() <= table.grid.outside
    assert table.value((50.0, 20.0, 0.0)) == table.grid.outside


@pytest.mark.parametrize("reacts", [False, True])
def test_simulated_evader_keeps_what_the_table_guarantees(
    table: ValueTable, reacts: bool
) -> None:
    """Against the answer of the table, and a car that reacts faster."""
    starts = np.random.default_rng(5).uniform(
        [-0.4, -0.9, 0.0], [1.2, 0.9, 0.0], (60, 3)
    )
    answers = by_table(table, GAME.turns, 1)
    closest = play(
        starts,
        by_table(table, GAME.twists, 0),
        towards(GAME.period / 8) if reacts else answers,
        period=GAME.period,
        duration=6.0,
        faces=True,
        reacts=reacts,
    )
    kept = closest - table.value(starts)
    assert kept.min() > -0.02 * table.grid.outside
    # Who is caught by an optimal pursuer cannot keep more.
    near = table.value(starts) < 0.95 * table.grid.outside
    if not reacts:
        assert np.median(kept[near]) < 0.05 * table.grid.outside


@pytest.mark.parametrize("speed", [1.0, 1.4])
def test_evader_that_is_as_fast_is_refused(speed: float) -> None:
    with pytest.raises(PlanError, match="evader_speed must be < pursuer"):
        game_of(speed)


def test_a_barrier_has_a_closed_form_below_the_guaranteed_distance() -> None:
    assert game_of(0.95).barrier(0.2) is None
    assert game_of(0.5).barrier(0.2) is None
    assert game_of(0.5).barrier(0.1) is not None
    assert sqrt(1.0 - 0.25) + 0.5 * pi / 6 - 1.0 == pytest.approx(
        guaranteed_distance(0.5)
    )
