"""Many games at once: against one, finer steps and closed forms."""

from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.circles import circles_of
from stepaside.theory.unicycle.simulation import (
    PlayedGame,
    accurate_step,
    play_games,
    simulate,
)
from stored_values import compare_stored, summed

GAMES = [
    Unicycles(1.0, 1.0, 0.5, 0.5),
    Unicycles(1.0, 1.1, 0.5, 0.7, np.pi / 2, "saturated"),
    Unicycles(1.0, 1.0, 0.5, 0.5, 0.3, "saturated"),
    Unicycles(1.1, 1.0, 0.5, 0.4, 1.0, side_rule="latched"),
    Unicycles(1.0, 1.0, 0.5, 0.5, 1.2, hysteresis=0.2),
    Unicycles(1.0, 1.0, 0.5, 0.5, 0.0),
    Unicycles(1.2, 1.0, 0.7, 0.4, 2.8, "saturated", side_rule="latched"),
    Unicycles(1.4, 1.0, 0.3, 0.8, 1.5, "saturated", hysteresis=0.05),
]
# A start; distances that it stays between, after the transient.
NO_CIRCLE = Unicycles(1.7651, 0.43, 2.0897, 1.0674, 1.3004)
ONE_CIRCLE = Unicycles(0.8831, 0.7117, 0.4482, 0.7551, 2.1371)
COUNTEREXAMPLES = [
    (NO_CIRCLE, (0.6049, -0.4196, 1.4271), (0.1506, 0.9964)),
    (ONE_CIRCLE, (0.943, -1.911, -0.219), (0.1614, 0.8259)),
]


def random_starts(count: int, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-np.pi, np.pi, (count, 2))
    return np.column_stack([rng.uniform(0.3, 6.0, count), angles])


def side_changes(run: PlayedGame) -> np.ndarray:
    """Times of changes of side."""
    times: np.ndarray = np.array(run.switches)[np.diff(run.sides) != 0]
    return times


@pytest.mark.parametrize("game", GAMES)
def test_every_game_is_that_which_is_played_alone(game: Unicycles) -> None:
    starts = random_starts(4)
    many = play_games(game, starts, 60.0, capture_distance=0.05)
    for i, start in enumerate(starts):
        one = simulate(
            game, RelativeStart(*start), 60.0, capture_distance=0.05
        )
        assert one.captured == many.captured[i]
        assert many.closest_distance[i] == pytest.approx(
            one.closest_distance, abs=1e-9
        )
        then = one.states([many.closest_time[i]])[0, 0]
        assert then == pytest.approx(one.closest_distance, abs=1e-9)
        assert many.sides[i] == one.sides[-1]
        if one.captured:
            assert many.capture_time[i] == pytest.approx(one.end_time)
        last = one.states([one.end_time])[0, :2]
        np.testing.assert_allclose(many.states[i, :2], last, atol=1e-9)


@pytest.mark.parametrize(("game", "start", "between"), COUNTEREXAMPLES)
def test_side_may_change_without_end_against_a_faster_pursuer(
    game: Unicycles,
    start: tuple[float, float, float],
    between: tuple[float, float],
) -> None:
    """As a motion between two distances, which neither end nor settle."""
    out = play_games(game, [start], 120.0, step=0.02)
    assert not out.captured[0] and out.circle[0] == -1
    run = simulate(game, RelativeStart(*start), 120.0)
    late = run.states(np.linspace(60.0, 120.0, 30_001))[:, 0]
    assert (late.min(), late.max()) == pytest.approx(between, abs=2e-4)
    changes = side_changes(run)
    gaps = np.diff(changes[changes > 60.0])
    assert len(gaps) > 15 and gaps.max() < 6.0


def test_without_a_stable_circle_the_side_changes_without_end() -> None:
    """Games of the parameter box of docs/unicycles.md."""
    rng = np.random.default_rng(5)
    found = 0
    while found < 5:
        vp, ve, kp, ke = np.exp(rng.uniform(-0.9, 0.9, 4)).tolist()
        game = Unicycles(vp, ve, kp, ke, float(rng.uniform(0.05, 3.0)))
        held = any(circle.stable for circle in circles_of(game))
        if vp < ve or held:
            continue
        found += 1
        slow, unit = min(kp, ke), ve / min(kp, ke)
        starts = random_starts(2, seed=found) * [unit, 1.0, 1.0]
        out = play_games(game, starts, 100.0 / slow, capture_distance=1e-9)
        assert not out.captured.any() and (out.circle == -1).all()
        for state in out.states.tolist():
            run = simulate(game, RelativeStart(*state), 20.0 / slow)
            changes = side_changes(run)
            assert len(changes) > 2 and changes[-1] > 10.0 / slow


@pytest.mark.parametrize("sign", [1, -1])
def test_return_to_an_edge_within_a_step_is_located(sign: int) -> None:
    """The line of sight outruns the evader for some milliseconds only."""
    game = Unicycles(1.0, 1.0, 0.5, 0.5, law="saturated")
    start = (1.2787314540990418, -sign * 2.7776696801482905, -sign * np.pi / 2)
    out = play_games(game, [start], 0.01, step=0.01)
    assert out.states[0, 2] == start[2]
    run = simulate(game, RelativeStart(*start), 0.01)
    assert 0.003 < run.switches[0] < 0.005
    assert run.states([0.01])[0, 2] == start[2]


def test_settled_time_is_the_last_arrival_at_the_circle() -> None:
    out = play_games(GAMES[0], [[5.0, 0.2, 0.4], [3.6, 0.0, 0.0]], 60.0)
    run = simulate(GAMES[0], RelativeStart(5.0, 0.2, 0.4), 60.0)
    before, after = run.states(out.settled_time[0] + [-0.05, 0.05])
    target = np.array([3.6012652646, -np.pi / 4, np.pi / 4])
    scale = np.array([3.6012652646, 1.0, 1.0])
    assert np.abs((before[:3] - target) / scale).max() > 0.02
    assert np.abs((after[:3] - target) / scale).max() < 0.02


@pytest.mark.parametrize(
    "game",
    [
        *GAMES[:2],
        *(pytest.param(g, marks=pytest.mark.slow) for g in GAMES[2:]),
    ],
)
def test_the_default_step_has_the_outcomes_of_a_tenth(game: Unicycles) -> None:
    starts = random_starts(300, seed=3)
    step = accurate_step(game)
    fine = play_games(game, starts, 40.0, step=0.1 * step)
    found = play_games(game, starts, 40.0)
    assert found.captured.tolist() == fine.captured.tolist()
    assert found.circle.tolist() == fine.circle.tolist()
    np.testing.assert_allclose(
        found.closest_distance, fine.closest_distance, atol=1.5e-7
    )


@pytest.mark.parametrize("side", [1, -1])
def test_given_side_is_kept_by_the_latched_rule(side: int) -> None:
    out = play_games(GAMES[3], random_starts(5), 0.5, side=side)
    assert out.sides.tolist() == [side] * 5


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("duration", {"duration": 0.0}),
        ("step", {"duration": 1.0, "step": -0.1}),
        ("capture_distance", {"duration": 1.0, "capture_distance": 0.0}),
        ("side", {"duration": 1.0, "side": 2}),
    ],
)
def test_values_out_of_range_are_refused_by_name(
    name: str, options: dict[str, Any]
) -> None:
    with pytest.raises(PlanError, match=f"^{name} must"):
        play_games(GAMES[0], [[1.0, 0.0, 0.0]], **options)


@pytest.mark.parametrize("number", range(len(GAMES)))
def test_random_games_end_as_stored(number: int) -> None:
    starts = random_starts(60, seed=number)
    found = play_games(GAMES[number], starts, 30.0, capture_distance=0.05)
    compare_stored("numbers.json", f"games {number}", summed(found), 1e-4)
