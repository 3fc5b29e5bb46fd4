"""Test how long games are played, and what an evader can change."""

import numpy as np
import pytest

from stepaside.theory.unicycle.circles import circles_of
from stepaside.theory.unicycle.simulation import play_games
from stepaside.theory.unicycle.start_maps import (
    duration_and_step,
    find_basins,
    random_starts,
)
from stepaside.theory.unicycle.unicycle_game import Game, make_game

FAST = make_game(2.0, 1.0, 1.0, 4.0)
SLOW_EVADER = make_game(1.0, 1.0, 2.0, 0.5)
STARTS = [[1.0, 0.3, 0.2], [2.0, -0.4, 0.5]]


def slowest(game: Game) -> float:
    return max(c.time_constant_s for c in circles_of(game) if c.stable)


@pytest.mark.parametrize("game", [FAST, SLOW_EVADER])
def test_games_last_until_the_slower_player_has_settled(game: Game) -> None:
    slow = min(game.pursuer.gain, game.evader.gain)
    found = find_basins(game, np.array(STARTS))
    assert found.duration == pytest.approx(40.0 / slow + 8.0 * slowest(game))
    unit = game.evader.speed / slow
    drawn = random_starts(game, 500)
    assert 0.3 * unit <= drawn[:, 0].min() < 0.4 * unit
    assert 3.9 * unit < drawn[:, 0].max() <= 4.0 * unit


def test_fractions_and_closest_approach_are_over_all_starts() -> None:
    """Captured games, and those that settle nowhere, count as well."""
    game, capture = FAST, 0.5
    starts = random_starts(game, 60, seed=2)
    found = find_basins(game, starts, capture_distance=capture)
    _, step = duration_and_step(game)
    out = play_games(
        game, starts, found.duration, step=step, capture_distance=capture
    )
    caught = int(out.captured.sum())
    assert 0 < caught < 60
    assert found.captured == pytest.approx(caught / 60)
    assert sum(found.shares) + found.captured + found.unsettled == (
        pytest.approx(1.0)
    )
    for number, share in enumerate(found.shares):
        settled = int((out.circle == number).sum())
        assert share == pytest.approx(settled / 60)
    closest = out.closest_distance.tolist()
    assert found.closest_distance == pytest.approx(sum(closest) / 60)
