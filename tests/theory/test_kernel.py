"""Test many games at once against the adaptive integrator and NumPy."""

import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from stepaside.core.compilation import load_numba
from stepaside.core.errors import PlanError
from stepaside.theory.unicycle.adaptive_simulation import simulate
from stepaside.theory.unicycle.compiled_batch import sine_cosine
from stepaside.theory.unicycle.kernel import (
    accurate_step,
    play_games,
)
from stepaside.theory.unicycle.relative_coordinates import RelativeStart
from stepaside.theory.unicycle.unicycle_game import Game, make_game

GAMES = [
    make_game(1.0, 1.0, 0.5, 0.5),
    make_game(1.0, 1.1, 0.5, 0.7, np.pi / 2, "saturated"),
    make_game(1.0, 1.0, 0.5, 0.5, 0.3, "saturated"),
    make_game(1.1, 1.0, 0.5, 0.4, 1.0, side_rule="latched"),
    make_game(1.0, 1.0, 0.5, 0.5, 1.2, hysteresis=0.2),
    make_game(1.0, 1.0, 0.5, 0.5, 0.0),
]


def random_starts(count: int, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-np.pi, np.pi, (count, 2))
    return np.column_stack([rng.uniform(0.3, 6.0, count), angles])


@pytest.mark.parametrize("game", GAMES)
def test_every_game_agrees_with_the_adaptive_integrator(game: Game) -> None:
    starts = random_starts(12)
    many = play_games(game, starts, 60.0, capture_distance=0.05)
    for i, start in enumerate(starts):
        one = simulate(
            game, RelativeStart(*start), 60.0, capture_distance=0.05
        )
        assert one.captured == many.captured[i]
        assert many.closest_distance[i] == pytest.approx(
            one.closest_distance, abs=1e-6
        )
        then = one.states([many.closest_time[i]])[0, 0]
        assert then == pytest.approx(one.closest_distance, abs=1e-6)
        assert many.sides[i] == one.sides[-1]
        if one.captured:
            assert many.capture_time[i] == pytest.approx(one.end_time)
        last = one.states([one.end_time])[0, :2]
        np.testing.assert_allclose(many.states[i, :2], last, atol=1e-6)


@pytest.mark.skipif(load_numba() is None, reason="Numba is not installed")
@pytest.mark.parametrize("game", GAMES)
def test_numpy_gives_the_same_answers(game: Game) -> None:
    starts = random_starts(300, seed=2)
    fast = play_games(game, starts, 8.0, backend="numba")
    slow = play_games(game, starts, 8.0, backend="numpy")
    for name in ("closest_distance", "closest_time", "settled_time"):
        np.testing.assert_allclose(
            getattr(fast, name), getattr(slow, name), atol=1e-9
        )
    np.testing.assert_allclose(fast.states, slow.states, atol=1e-8)


def test_games_are_simulated_without_numba() -> None:
    code = (
        "import sys; sys.modules['numba'] = None\n"
        "import numpy as np\n"
        "from stepaside.theory.unicycle.kernel import play_games\n"
        "from stepaside.theory.unicycle.unicycle_game import make_game\n"
        "starts = [[2.0, 0.5, 2.0], [1.0, -2.0, -3.0]]\n"
        "game = make_game(1.0, 1.0, 0.5, 0.5)\n"
        "out = play_games(game, starts, 5.0)\n"
        "print(*out.closest_distance)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
    )
    starts = [[2.0, 0.5, 2.0], [1.0, -2.0, -3.0]]
    here = play_games(GAMES[0], starts, 5.0).closest_distance
    there = [float(word) for word in done.stdout.split()]
    np.testing.assert_allclose(there, here, atol=1e-9)


def test_branchless_sine_and_cosine_are_exact() -> None:
    x = np.linspace(-12.0, 12.0, 2001)
    ours = np.array([sine_cosine(float(v)) for v in x])
    assert np.abs(ours[:, 0] - np.sin(x)).max() < 5e-16
    assert np.abs(ours[:, 1] - np.cos(x)).max() < 5e-16


def test_settled_time_is_the_last_arrival_at_the_circle() -> None:
    out = play_games(GAMES[0], [[5.0, 0.2, 0.4], [3.6, 0.0, 0.0]], 60.0)
    run = simulate(GAMES[0], RelativeStart(5.0, 0.2, 0.4), 60.0)
    before, after = run.states(out.settled_time[0] + [-0.05, 0.05])
    target = np.array([3.6012652646, -np.pi / 4, np.pi / 4])
    scale = np.array([3.6012652646, 1.0, 1.0])
    assert np.abs((before[:3] - target) / scale).max() > 0.02
    assert np.abs((after[:3] - target) / scale).max() < 0.02


BACKENDS = ["numpy", *(["numba"] if load_numba() else [])]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("game", [GAMES[0], GAMES[2], GAMES[3]])
def test_whole_turns_of_a_start_change_nothing(
    game: Game, backend: str
) -> None:
    """Nor where the game is over at once: its state is wrapped too."""
    starts = np.array([[2.0, 0.5, 2.0], [1.0, -2.0, -3.0], [0.04, 1, -1]])
    turns = 2.0 * np.pi * np.array([[0, -1, -1], [0, 1, 1], [0, -1, 1]])
    plain, turned = (
        play_games(game, s, 2.0, capture_distance=0.05, backend=backend)
        for s in (starts, starts + turns)
    )
    np.testing.assert_allclose(turned.states, plain.states, atol=1e-9)
    np.testing.assert_allclose(
        turned.closest_distance, plain.closest_distance, atol=1e-12
    )
    assert turned.sides.tolist() == plain.sides.tolist()
    assert np.abs(turned.states[2, 1:]).max() <= np.pi


def test_pursuer_straight_behind_is_not_turned_round() -> None:
    """At pi the side is -1, at -pi it is +1."""
    out = play_games(GAMES[3], [[1.0, 0, np.pi], [1.0, 0, -np.pi]], 0.01)
    assert out.sides.tolist() == [-1, 1]


@pytest.mark.parametrize("backend", BACKENDS)
def test_start_within_the_capture_distance_is_captured_immediately(
    backend: str,
) -> None:
    """Also where it would be out of reach after one step."""
    starts = [
        [0.399, 3.0, 0.0],
        [0.3, 1.0, -1.0],
        [0.4, 0.0, 0.0],
        [3.6012652646, 0, 0],
    ]
    out = play_games(
        GAMES[0], starts, 1.0, capture_distance=0.4, backend=backend
    )
    assert out.captured.tolist() == [True, True, True, False]
    assert out.closest_distance[:3].tolist() == [0.399, 0.3, 0.4]
    np.testing.assert_array_equal(out.capture_time, [0.0, 0.0, 0.0, np.nan])
    np.testing.assert_array_equal(out.states[:3], starts[:3])
    assert np.isinf(out.settled_time).all()
    assert out.circle.tolist() == [-1, -1, -1, -1]


@pytest.mark.parametrize("backend", BACKENDS)
def test_duration_is_rounded_up_to_whole_steps(backend: str) -> None:
    """Straight on at two speeds, the distance tells the time."""
    game = make_game(2.0, 1.0, 0.5, 0.5, 0.0)
    for duration, step, expected in (
        (0.3, 0.1, 0.3),
        (0.31, 0.1, 0.4),
        (0.05, 0.1, 0.1),
    ):
        out = play_games(
            game, [[5.0, 0.0, 0.0]], duration, step=step, backend=backend
        )
        assert out.states[0, 0] == pytest.approx(5.0 - expected)
        assert out.closest_time[0] == pytest.approx(expected)


@pytest.mark.skipif(load_numba() is None, reason="Numba is not installed")
@pytest.mark.parametrize("game", GAMES)
def test_the_default_step_is_accurate_and_coarse(game: Game) -> None:
    """Outcomes are those of a tenth of the step; four steps are too long."""
    starts = random_starts(300, seed=3)
    step = accurate_step(game)
    fine = play_games(game, starts, 40.0, step=0.1 * step)
    found = play_games(game, starts, 40.0)
    assert found.captured.tolist() == fine.captured.tolist()
    assert found.circle.tolist() == fine.circle.tolist()
    off = np.abs(found.closest_distance - fine.closest_distance)
    assert off.max() < 3e-7
    coarse = play_games(game, starts, 40.0, step=4.0 * step)
    off = np.abs(coarse.closest_distance - fine.closest_distance)
    assert off.max() > 3e-7


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
        ("backend", {"duration": 1.0, "backend": "fortran"}),
        ("side", {"duration": 1.0, "side": 2}),
    ],
)
def test_values_out_of_range_are_refused_by_name(
    name: str, options: dict[str, Any]
) -> None:
    with pytest.raises(PlanError, match=f"^{name} must"):
        play_games(GAMES[0], [[1.0, 0.0, 0.0]], **options)
