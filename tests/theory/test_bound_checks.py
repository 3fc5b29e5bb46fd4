"""Test the error checks of a bound on synthetic tables."""

from dataclasses import replace
from statistics import fmean
from typing import Any

import numpy as np
import pytest

from stepaside.theory.bound import (
    bound_checks as checks,
)
from stepaside.theory.bound import (
    grid_refinement as refine,
)
from stepaside.theory.bound.bound_checks import check_by_playing
from stepaside.theory.bound.grid_refinement import differences, refine_bound
from stepaside.theory.bound.relative_game import (
    fixed_pursuit_game,
    two_car_game,
)
from stepaside.theory.bound.state_grid import Grid
from stepaside.theory.bound.value_solver import (
    march,
    solve_bound,
)
from stepaside.theory.bound.value_table import Bound

GAME = fixed_pursuit_game(0.12, 0.1, 0.2)
SMALL = Grid.cube(0.1, 2.0, 10)


def table(grid: Grid, offset: float = 0.0, rise: float = 0.0) -> Bound:
    """Values that are half of the distance, more or less."""
    a, r, psi = grid.axes()
    values = 0.5 * r[:, None] + rise * np.abs(a)[:, None, None] + 0.0 * psi
    plain = (values + offset).astype(np.float32)
    return Bound(GAME, grid, plain, 10.0, 0.0, 0.0, 1.0)


def test_errors_of_simulated_games_are_over_all_games(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bound, random = table(SMALL), np.random.default_rng(3)
    starts = np.column_stack(
        [random.uniform(0.3, 1.9, 200), random.uniform(-3, 3, (200, 2))]
    )
    promised = bound.value(*starts.T)
    played: list[Any] = []

    def play(*given: Any) -> Any:
        played.append(promised + random.normal(0.02, 0.05, 200))
        return played[-1]

    monkeypatch.setattr(checks, "play_bound", play)
    rows = check_by_playing(bound, 200, starts=starts)
    assert rows[0].name == "optimal" and len(rows) == len(played) > 3
    for row, kept in zip(rows, played, strict=True):
        off = (kept - promised).tolist()
        ordered = sorted(abs(each) for each in off)
        assert row.mean_error == pytest.approx(fmean(off))
        assert ordered[188] <= row.most <= ordered[191]
        assert row.below == pytest.approx(-min(off))
        assert row.above == pytest.approx(max(off))
        assert row.closest == pytest.approx(fmean(kept.tolist()))
        ratio = fmean(kept.tolist()) / fmean(promised.tolist())
        assert row.over_bound == pytest.approx(ratio)


def test_game_above_the_bound_is_not_below_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bound = table(SMALL)
    starts = np.array([[0.5, 0.1, 0.2], [1.0, 1.0, -2.0]])
    for sign in (1.0, -1.0):
        kept = bound.value(*starts.T) + sign * np.array([0.1, 0.3])
        monkeypatch.setattr(checks, "play_bound", lambda *_, k=kept: k)
        row = check_by_playing(bound, 2, starts=starts)[0]
        assert row.mean_error == pytest.approx(sign * 0.2)
        worse, better = (row.above, row.below)[:: int(sign)]
        assert worse == pytest.approx(0.3) and better == 0.0


def test_refinement_measures_differences_at_every_node(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Mean, 95 % and worst; the order is that by which the mean falls.

    A single node is off the most.
    """
    grids = [Grid.cube(0.1, 2.0, 36)]
    grids += [grids[0].coarser(), grids[0].coarser().coarser()]
    off = dict(zip(grids, (0.0, 0.04, 0.16), strict=True))

    def solve(game: Any, grid: Grid, **given: Any) -> Bound:
        made = table(grid, off[grid], 0.1 * off[grid])
        values = made.values.copy()
        values[2, 3, 4] += 10.0 * off[grid]
        return replace(made, values=values)

    monkeypatch.setattr(refine, "solve_bound", solve)
    best, rows = refine_bound(GAME, grids[0], 2)
    assert best.grid == grids[0] and len(rows) == 2
    tables = [solve(GAME, grid) for grid in reversed(grids)]
    for row, coarse, fine in zip(rows, tables, tables[1:], strict=False):
        apart = np.sort(differences(coarse, fine).ravel())
        assert row.grid == coarse.grid
        assert row.mean == pytest.approx(float(apart.mean()))
        assert row.worst == pytest.approx(float(apart[-1]))
        at = int(0.95 * (len(apart) - 1))
        assert apart[at] - 1e-9 <= row.most <= apart[at + 1] + 1e-9
        assert apart[int(0.93 * len(apart))] < row.most


def test_table_holds_the_final_values_of_the_march() -> None:
    """Late decrease: the change over the last tenth of the horizon."""
    horizon = 8.0
    found = solve_bound(GAME, SMALL, horizon=horizon)
    before = found.values.copy()
    steps = [
        (now, values.copy()) for now, values in march(GAME, SMALL, horizon)
    ]
    assert steps[-1][0] == pytest.approx(horizon)
    np.testing.assert_array_equal(found.values, steps[-1][1])
    late = next(values for now, values in steps if now >= 0.9 * horizon)
    fell = np.abs(late - steps[-1][1])
    assert found.falling_mean == pytest.approx(float(fell.mean()), abs=1e-9)
    assert found.falling_worst == pytest.approx(float(fell.max()), abs=1e-9)
    assert found.falling_worst > 0.0
    solve_bound(GAME, SMALL, horizon=0.5 * horizon)
    np.testing.assert_array_equal(found.values, before)
    with pytest.raises(ValueError, match="read-only"):
        found.values[0, 0, 0] = 9.0


def test_lengths_and_times_of_a_bound_scale_with_its_units() -> None:
    """Twice the speed is twice the length; twice the rates, half the time."""
    plain = solve_bound(GAME, SMALL, horizon=6.0)
    fast = solve_bound(
        fixed_pursuit_game(0.24, 0.2, 0.2),
        Grid.cube(0.2, 4.0, 10),
        horizon=6.0,
    )
    quick = solve_bound(fixed_pursuit_game(0.24, 0.2, 0.4), SMALL, horizon=3.0)
    np.testing.assert_allclose(fast.values, 2.0 * plain.values, atol=1e-5)
    np.testing.assert_allclose(quick.values, plain.values, atol=1e-5)
    # By eq. (2) the pursuer turns by at most half a turn times its gain.
    assert GAME.evader_turn == pytest.approx(0.2 * np.pi)
    for game in (GAME, two_car_game(0.1, 0.1, 0.5)):
        assert game.unit * game.rate == pytest.approx(game.evader_speed)


def test_optimal_turning_rates_keep_their_limits_and_are_mirrored() -> None:
    bound = solve_bound(two_car_game(0.12, 0.1, 0.4, 0.5), SMALL, horizon=6.0)
    random = np.random.default_rng(1)
    r = random.uniform(0.2, 1.9, 100)
    a, psi = random.uniform(-3.0, 3.0, (2, 100))
    for turn, limit in ((bound.evader_turn, 0.5), (bound.pursuer_turn, 0.4)):
        left, right = turn(r, a, psi), turn(r, -a, -psi)
        assert np.abs(left).max() <= limit + 1e-9
        np.testing.assert_allclose(left, -right, atol=2e-3 * limit)
    np.testing.assert_allclose(
        bound.value(r, a, psi), bound.value(r, -a, -psi), atol=1e-6
    )
    turn_a, turn_psi = (2.0 * np.pi * np.sign(angle) for angle in (a, psi))
    turned = bound.value(r, a - turn_a, psi - turn_psi)
    np.testing.assert_allclose(turned, bound.value(r, a, psi), atol=1e-6)
