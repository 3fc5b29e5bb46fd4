"""Test how long games from random starts are played."""

import numpy as np
import pytest

from stepaside.theory.unicycle import Unicycles
from stepaside.theory.unicycle.circles import settling_time
from stepaside.theory.unicycle.start_maps import find_basins, random_starts

FAST = Unicycles(2.0, 1.0, 1.0, 4.0)
SLOW_EVADER = Unicycles(1.0, 1.0, 2.0, 0.5)
STARTS = [[1.0, 0.3, 0.2], [2.0, -0.4, 0.5]]


@pytest.mark.parametrize("game", [FAST, SLOW_EVADER])
def test_games_last_until_the_slower_player_has_settled(
    game: Unicycles,
) -> None:
    found = find_basins(game, np.array(STARTS))
    assert (found.settled_time < 0.7 * settling_time(game)).all()
    unit = game.evader_speed / min(game.pursuer_gain, game.evader_gain)
    drawn = random_starts(game, 500)
    assert 0.3 * unit <= drawn[:, 0].min() < 0.4 * unit
    assert 3.9 * unit < drawn[:, 0].max() <= 4.0 * unit


def test_shares_are_of_all_starts() -> None:
    """Captured games, and those that settle nowhere, count as well."""
    starts = random_starts(FAST, 60, seed=2)
    out = find_basins(FAST, starts, capture_distance=0.5)
    caught, ended = int(out.captured.sum()), int((out.circle >= 0).sum())
    assert 0 < caught < 60 and caught + ended <= 60
    assert out.shares(2) == [(out.circle == n).sum() / 60 for n in (0, 1)]
