"""Test the solver of bounds against laws and a second solver."""

from dataclasses import replace
from math import pi, tau
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from stepaside.core.errors import PlanError
from stepaside.theory.bound import (
    Bound,
    BoundGame,
    Grid,
    fixed_pursuit_game,
    solve_bound,
    two_car_game,
)
from stepaside.theory.bound.grid_refinement import refine_bound
from stepaside.theory.bound.state_grid import fill_ghosts

Array = NDArray[np.float64]
PURSUIT = fixed_pursuit_game(1.0, 1.0, 1.0)
CARS = two_car_game(1.0, 1.0, 1.0)
SMALL = Grid(0.4, 3.4, 16, 16, 16)


@pytest.fixture(scope="module")
def pursuit() -> Bound:
    return solve_bound(PURSUIT, SMALL, horizon=3.0)


@pytest.fixture(scope="module")
def cars() -> Bound:
    return solve_bound(CARS, SMALL, horizon=5.0)


def step_back(
    bound: Bound, value: Array, time_step: float, turns: int = 5
) -> Array:
    """One step of a semi-Lagrangian scheme, written independently.

    Both players choose among a few turning rates, the states move along
    straight lines in (r, a, psi), and the value there is interpolated.
    """
    game, grid = bound.game, bound.grid
    a, r, psi = (
        x.reshape(shape)
        for x, shape in zip(
            grid.axes(), ((-1, 1, 1), (1, -1, 1), (1, 1, -1)), strict=True
        )
    )
    closing = game.evader_speed * np.cos(psi) - game.pursuer_speed * np.cos(a)
    swing = game.pursuer_speed * np.sin(a) - game.evader_speed * np.sin(psi)
    swing = swing / r
    table = replace(bound, values=value.astype(np.float32))
    best = np.full(value.shape, np.inf)
    free = np.linspace(-1.0, 1.0, turns if game.pursuer_turn else 1)
    for deviation in game.pursuer_turn * free:
        turn_p = game.pursuer_gain * a + deviation
        answers = [
            table.value(
                r + time_step * closing,
                a + time_step * (swing - turn_p),
                psi + time_step * (swing - turn_e),
            )
            for turn_e in game.evader_turn * np.linspace(-1.0, 1.0, turns)
        ]
        best = np.minimum(best, np.max(answers, axis=0))
    least: Array = np.minimum(best, np.broadcast_to(r, best.shape))
    return np.maximum(least, grid.near)


@pytest.mark.parametrize("game", [PURSUIT, CARS], ids=["pursuit", "cars"])
def test_independent_solver_converges_to_the_same_value(
    game: BoundGame,
) -> None:
    """Semi-Lagrangian steps in NumPy err by their time step, and only so."""
    fine = solve_bound(game, Grid(0.4, 3.4, 46, 48, 48), horizon=2.0)
    a, r, psi = SMALL.axes()
    true = fine.value(r[:, None], a[:, None, None], psi)
    bound = solve_bound(game, SMALL, horizon=2.0)
    errors = []
    for count in (10, 20):
        value = np.broadcast_to(r[:, None], SMALL.shape).astype(np.float64)
        for _ in range(count):
            value = step_back(bound, value, 2.0 / count)
        errors.append(np.abs(value - true).mean())
    assert errors[1] < 0.045 and errors[1] < errors[0]
    assert np.abs(bound.values - true).mean() < 0.5 * errors[1]


def test_running_straight_away_keeps_the_distance(
    pursuit: Bound, cars: Bound
) -> None:
    r = np.array([0.9, 1.7, 2.6])
    for bound in (pursuit, cars):
        np.testing.assert_allclose(bound.value(r, 0.0, 0.0), r, atol=0.05)
        assert (bound.values <= bound.grid.axes()[1][:, None] + 1e-6).all()
        assert (bound.values >= bound.grid.near).all()


def test_closest_approach_falls_with_the_angle_to_turn(
    cars: Bound,
) -> None:
    values = cars.value(2.5, 0.0, np.linspace(0.0, pi, 7))
    assert (np.diff(values) < 0.0).all()


def test_value_is_symmetric_under_mirroring(cars: Bound) -> None:
    r, a, psi = (
        np.random.default_rng(3)
        .uniform([0.5, -pi, -pi], [3.3, pi, pi], (200, 3))
        .T
    )
    here = cars.value(r, a, psi)
    np.testing.assert_allclose(cars.value(r, -a, -psi), here, atol=1e-6)
    turned = cars.value(r, a - tau * np.sign(a), psi - tau * np.sign(psi))
    np.testing.assert_allclose(turned, here, atol=1e-6)


def test_free_pursuer_is_no_worse_than_one_with_a_law(
    pursuit: Bound,
) -> None:
    free = solve_bound(two_car_game(1.0, 1.0, pi), SMALL, horizon=3.0)
    assert (free.values - pursuit.values).max() < 0.05
    assert (free.values - pursuit.values).mean() < -0.01


@pytest.mark.parametrize(
    ("better", "sign"),
    [
        ({"evader_turn": 1.5 * pi}, 1),
        ({"pursuer_speed": 1.2}, -1),
        ({"pursuer_gain": 1.5}, -1),
    ],
    ids=["evader turns", "pursuer speed", "pursuer turns"],
)
def test_value_is_monotone_in_the_capabilities(
    pursuit: Bound, better: dict[str, float], sign: int
) -> None:
    other = solve_bound(replace(PURSUIT, **better), SMALL, horizon=3.0)
    change = sign * (other.values - pursuit.values)
    assert change.mean() > 2e-3 and change.min() > -0.1


def test_lengths_scale_with_speed_over_gain(pursuit: Bound) -> None:
    """NAO's 0.1 m/s and 0.2 1/s are the same game at half the size."""
    small = solve_bound(
        fixed_pursuit_game(0.1, 0.1, 0.2),
        Grid(0.2, 1.7, 16, 16, 16),
        horizon=15.0,
    )
    assert small.horizon * 0.2 == pursuit.horizon
    np.testing.assert_allclose(2 * small.values, pursuit.values, atol=2e-3)


def test_value_falls_with_the_horizon_and_converges() -> None:
    values = [
        solve_bound(PURSUIT, SMALL, horizon=T).values for T in (0.3, 1.0, 3.0)
    ]
    first, second = values[0] - values[1], values[1] - values[2]
    assert first.min() > -0.02 and first.max() > 0.3
    assert 0.0 < second.mean() < 1e-2 * first.mean()


def test_skipped_rows_would_not_have_changed(
    cars: Bound, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("stepaside.theory.bound.value_solver.STILL", -1.0)
    every = solve_bound(CARS, SMALL, horizon=5.0)
    np.testing.assert_allclose(cars.values, every.values, atol=3e-3)
    assert np.abs(cars.values - every.values).mean() < 5e-5


def test_smaller_time_steps_change_little(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """While the value still falls: the steps are of third order."""
    large = solve_bound(CARS, SMALL, horizon=0.8).values
    monkeypatch.setattr("stepaside.theory.bound.value_solver.COURANT", 0.2)
    small = solve_bound(CARS, SMALL, horizon=0.8).values
    assert np.abs(large - small).mean() < 3e-4


def test_refinement_converges_to_the_value() -> None:
    grid = Grid(0.4, 3.4, 25, 24, 24)
    _, rows = refine_bound(PURSUIT, grid, 1, horizon=2.0)
    assert [row.grid for row in rows] == [grid.coarser()]
    assert 0.0 < rows[0].mean < 0.012
    assert rows[0].mean <= rows[0].worst


def test_progress_adds_up_to_the_horizon() -> None:
    done: list[float] = []
    solve_bound(PURSUIT, SMALL, horizon=0.5, progress=done.append)
    assert sum(done) == pytest.approx(0.5) and min(done) > 0.0
    done.clear()
    refine_bound(
        PURSUIT, Grid.cube(0.4, 3.4, 32), 1, horizon=0.1, progress=done.append
    )
    assert sum(done) == pytest.approx(1.0)


def test_ghosts_continue_the_game() -> None:
    """Mirrored beyond a = 0 and pi, periodic in psi, straight in r."""
    v = np.zeros((10, 11, 14), np.float32)
    a, r, psi = Grid(1.0, 2.0, 8, 8, 8).axes()
    r = r[:5]

    def value(a: Array, r: Array, psi: Array) -> Array:
        return np.sin(a) * np.sin(psi) + 0.5 * (np.cos(a + psi) + r)

    v[3:-3, 3:-3, 3:-3] = value(a[:, None, None], r[:, None], psi)
    fill_ghosts(v)
    steps = np.arange(-3, 11)
    wide = (np.arange(-3, 7) + 0.5) * tau / 8, -pi + (steps + 0.5) * tau / 8
    true = value(wide[0][:, None, None], r[:, None], wide[1])
    np.testing.assert_allclose(v[:, 3:-3], true, atol=1e-6)
    step = r[1] - r[0]
    for n in range(1, 4):
        np.testing.assert_allclose(
            v[:, -4 + n], v[:, -4] + n * step / 2, atol=1e-5
        )
        np.testing.assert_array_equal(v[:, 3 - n], v[:, 3])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Grid(1.0, 1.0, 16, 16, 16), "far - near"),
        (lambda: Grid(0.0, 1.0, 16, 16, 16), "near"),
        (lambda: Grid(0.1, 1.0, 16, 17, 16), "errors must be even"),
        (lambda: Grid(0.1, 1.0, 4, 16, 16), "distances must be >= 8"),
        (lambda: fixed_pursuit_game(1.0, 1.0, float("nan")), "pursuer_gain"),
        (lambda: two_car_game(1.0, 1.0, 0.0, 1.0), "pursuer_turn"),
        (lambda: two_car_game(1.0, -1.0, 1.0), "evader_speed"),
        (lambda: solve_bound(CARS, SMALL, horizon=-1.0), "horizon"),
        (lambda: refine_bound(CARS, SMALL, 9), "must be >="),
        (lambda: refine_bound(CARS, SMALL, -1), "refine"),
    ],
)
def test_bad_values_are_refused_by_name(make: Any, words: str) -> None:
    with pytest.raises(PlanError, match=words):
        make()


def test_too_many_steps_are_refused_before_the_computation() -> None:
    game = fixed_pursuit_game(1.0, 1.0, 0.5, 1e9)
    with pytest.raises(PlanError, match="horizon must be at most .* steps"):
        solve_bound(game, Grid.cube(0.3, 4.0, 16), horizon=1.0)
