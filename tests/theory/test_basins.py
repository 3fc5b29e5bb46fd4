"""Test how long games are played, and what an evader can change."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from stepaside.theory.unicycle.adaptive_simulation import simulate
from stepaside.theory.unicycle.basins import (
    duration_and_step,
    find_basins,
    random_starts,
    settled_fractions,
)
from stepaside.theory.unicycle.batch import Outcomes, play_games
from stepaside.theory.unicycle.circles import circles_of
from stepaside.theory.unicycle.relative_coordinates import RelativeStart
from stepaside.theory.unicycle.unicycle_game import Game, make_game

FAST = make_game(2.0, 1.0, 1.0, 4.0)
SLOW_EVADER = make_game(1.0, 1.0, 2.0, 0.5)
NO_CIRCLE = make_game(1.0, 1.0, 0.5, 2.0, 0.0)
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


def test_duration_is_bounded_and_needs_no_circle() -> None:
    starts = np.array(STARTS)
    assert find_basins(NO_CIRCLE, starts).duration == pytest.approx(80.0)
    wide = make_game(1.0, 1.0, 0.5, 2.0, 0.02)
    assert slowest(wide) > 100.0
    assert find_basins(wide, starts).duration == pytest.approx(800.0)
    asked = find_basins(FAST, starts, duration=0.5)
    assert asked.duration == 0.5 and asked.unsettled == 1.0
    assert asked.captured == 0.0 and asked.shares == (0.0, 0.0)


def test_fractions_count_games_per_circle() -> None:
    out = play_games(FAST, STARTS, 0.1)
    some = replace(out, circle=np.array([1, -1, 1, 0]))
    assert settled_fractions(some, 3) == (0.25, 0.5, 0.0)


def test_mean_closest_approach_is_that_of_the_games() -> None:
    starts = np.array(STARTS)
    found = find_basins(FAST, starts, duration=5.0)
    runs = [simulate(FAST, RelativeStart(*start), 5.0) for start in STARTS]
    expected = sum(run.closest_distance for run in runs) / 2.0
    assert found.closest_distance == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ("gain", "step"), [(1.0, 0.02), (4.0, 0.02), (10.0, 0.01), (0.1, 0.1)]
)
def test_step_is_short_for_both_players(
    gain: float, step: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    from stepaside.theory.unicycle import basins

    asked: list[dict[str, float]] = []

    def watched(
        game: Game, starts: Any, duration: float, **options: float
    ) -> Outcomes:
        asked.append(options)
        return play_games(game, starts, duration, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(basins, "play_games", watched)
    game = make_game(2.0, 1.0, 1.0, gain)
    starts = np.array(STARTS)
    find_basins(game, starts, duration=0.1, capture_distance=0.2)
    assert asked[0]["step"] == pytest.approx(step)
    assert asked[0]["capture_distance"] == 0.2


def test_random_starts_depend_on_the_seed() -> None:
    one, other = (random_starts(FAST, 5, seed=seed) for seed in (1, 2))
    np.testing.assert_array_equal(one, random_starts(FAST, 5, seed=1))
    assert np.all(one != other)


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
