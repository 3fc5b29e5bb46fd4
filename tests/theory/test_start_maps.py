"""Test maps over starts and the search of the worst one."""

from math import radians
from typing import Any

import numpy as np
import pytest

from stepaside.theory.unicycle import Unicycles
from stepaside.theory.unicycle.simulation import play_games, simulate
from stepaside.theory.unicycle.start_maps import find_worst_start, map_starts


def facing(*shape: int) -> Any:
    """Axes of starts within the field of view, from 0.8 to 2 m."""
    ends = (0.8, 2.0), radians(30) * SIDES, radians(30.5) * SIDES
    return tuple(map(np.linspace, *zip(*ends, strict=True), shape))


NAO = Unicycles(0.1, 0.1, 0.2, 0.2)
SIDES = np.array([-1.0, 1.0])


def test_map_is_symmetric_under_mirroring() -> None:
    found = map_starts(NAO, facing(3, 6, 6), 40.0, step=0.05)
    values = found.grid("closest_distance")
    np.testing.assert_allclose(values, values[:, ::-1, ::-1], atol=1e-7)


@pytest.mark.parametrize(
    "game", [NAO, Unicycles(0.1, 0.1, 0.2, 0.2, np.pi / 2, "saturated")]
)
def test_independent_optimiser_finds_nothing_closer(game: Unicycles) -> None:
    from scipy.optimize import differential_evolution

    found = map_starts(game, facing(4, 11, 11), 40.0, step=0.05)
    start, least = find_worst_start(game, found, 40.0, step=0.05)

    def closest(rows: np.ndarray) -> np.ndarray:
        starts = rows.T.reshape(-1, 3)
        return play_games(game, starts, 40.0, step=0.05).closest_distance

    rival = differential_evolution(
        closest,
        [tuple(axis[[0, -1]]) for axis in found.axes],
        rng=7,
        maxiter=40,
        popsize=20,
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=0.0,
    )
    assert least < rival.fun + 1e-3
    run = simulate(game, start, 40.0)
    assert run.closest_distance == pytest.approx(least, abs=1e-6)


def test_facing_evader_outside_the_safety_area_stays_clear() -> None:
    """Observed on a grid: all settle, none comes within two bodies."""
    found = map_starts(NAO, facing(4, 13, 13), 150.0, step=0.05)
    assert np.isfinite(found.outcomes.settled_time).all()
    assert found.outcomes.closest_distance.min() > 0.4


def test_evader_looking_away_can_walk_into_its_pursuer() -> None:
    options = {"step": 0.05, "capture_distance": 0.3}
    bearings = np.linspace(-np.pi, np.pi, 19)
    axes = np.array([0.8, 1.2]), bearings, bearings
    found = map_starts(NAO, axes, 40.0, **options)
    start, least = find_worst_start(NAO, found, 40.0, **options)
    assert least == pytest.approx(0.3)
    run = simulate(NAO, start, 40.0, capture_distance=0.3)
    assert run.captured
