"""Test maps over starts and the search of the worst one."""

from math import radians

import numpy as np
import pytest

from stepaside.theory.unicycle.simulation import play_games, simulate
from stepaside.theory.unicycle.start_maps import (
    StartBox,
    find_worst_start,
    map_starts,
)
from stepaside.theory.unicycle.unicycle_game import (
    Game,
    RelativeStart,
    make_game,
)

FACING = StartBox(0.8, 2.0, radians(30), radians(30.5))
NAO = make_game(0.1, 0.1, 0.2, 0.2)


def test_map_is_symmetric_under_mirroring() -> None:
    found = map_starts(NAO, FACING, 40.0, shape=(3, 6, 6), step=0.05)
    values = found.grid("closest_distance")
    np.testing.assert_allclose(values, values[:, ::-1, ::-1], atol=1e-7)


@pytest.mark.parametrize(
    "game", [NAO, make_game(0.1, 0.1, 0.2, 0.2, np.pi / 2, "saturated")]
)
def test_independent_optimiser_finds_nothing_closer(game: Game) -> None:
    from scipy.optimize import differential_evolution

    found = map_starts(game, FACING, 40.0, shape=(4, 11, 11), step=0.05)
    worst = find_worst_start(game, found, FACING, 40.0, step=0.05)

    def closest(rows: np.ndarray) -> np.ndarray:
        starts = rows.T.reshape(-1, 3)
        return play_games(game, starts, 40.0, step=0.05).closest_distance

    rival = differential_evolution(
        closest,
        list(zip(FACING.low, FACING.high, strict=True)),
        rng=7,
        maxiter=40,
        popsize=20,
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=0.0,
    )
    assert worst.closest_distance < rival.fun + 1e-3
    run = simulate(game, worst.start, 40.0)
    assert run.closest_distance == pytest.approx(
        worst.closest_distance, abs=1e-6
    )


def test_facing_evader_outside_the_safety_area_stays_clear() -> None:
    """Observed on a grid: all settle, none comes within two bodies."""
    found = map_starts(NAO, FACING, 150.0, shape=(4, 13, 13), step=0.05)
    assert np.isfinite(found.outcomes.settled_time).all()
    assert found.outcomes.closest_distance.min() > 0.4


def test_evader_looking_away_can_walk_into_its_pursuer() -> None:
    box = StartBox(0.8, 1.2)
    options = {"step": 0.05, "capture_distance": 0.3}
    found = map_starts(NAO, box, 40.0, shape=(2, 19, 19), **options)
    worst = find_worst_start(NAO, found, box, 40.0, **options)
    assert worst.captured
    run = simulate(NAO, worst.start, 40.0, capture_distance=0.3)
    assert run.captured and isinstance(worst.start, RelativeStart)
