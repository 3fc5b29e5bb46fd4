"""Test tables of bounds: lookup, files, and games that are played."""

import json
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.bound import bound as bound_command
from stepaside.cli.main import main
from stepaside.core.errors import PlanError
from stepaside.theory.bound import (
    Bound,
    Grid,
    fixed_pursuit_game,
    load_bound,
    solve_bound,
    two_car_game,
)
from stepaside.theory.bound.bound_checks import (
    check_by_playing,
    draw_starts,
    fixed_angle_evader,
    play_bound,
)
from stepaside.theory.unicycle import make_game, play_games

GRID = Grid(0.3, 4.0, 33, 32, 32)


@pytest.fixture(scope="module")
def pursuit() -> Bound:
    return solve_bound(fixed_pursuit_game(1.0, 1.0, 1.0), GRID, horizon=4.0)


@pytest.fixture(scope="module")
def cars() -> Bound:
    game = two_car_game(1.0, 1.0, 1.0)
    return solve_bound(game, replace(GRID, far=6.0))


def test_lookup_returns_the_values_at_the_nodes(pursuit: Bound) -> None:
    a, r, psi = pursuit.grid.axes()
    found = pursuit.value(r[:, None], a[:, None, None], psi)
    np.testing.assert_allclose(found, pursuit.values, atol=1e-5)
    assert pursuit.value(1.0, 0.2, 0.3).shape == ()
    assert pursuit.value(0.1, 0.2, 0.3) == pytest.approx(0.1)
    edge = pursuit.value(GRID.far, 0.2, 0.3)
    assert pursuit.value(GRID.far + 1, 0.2, 0.3) == pytest.approx(edge + 1)


def test_pursuer_turns_towards_and_evader_away(cars: Bound) -> None:
    """Evader to the left: turn left; pursuer on its left: turn right."""
    assert cars.pursuer_turn(2.0, 1.0, 0.0) == pytest.approx(1.0)
    assert cars.evader_turn(2.0, 0.0, 1.0) == pytest.approx(1.0)
    assert cars.evader_turn(2.0, 0.0, -1.0) == pytest.approx(-1.0)


def test_pursuer_with_a_law_follows_it(pursuit: Bound) -> None:
    turns = pursuit.pursuer_turn(2.0, np.array([0.5, -1.0, 4.0]), 0.0)
    np.testing.assert_allclose(turns, [0.5, -1.0, 4.0 - 2 * pi])


def test_optimal_evader_reaches_the_value_of_the_table(
    pursuit: Bound, cars: Bound
) -> None:
    """And no other keeps more, beyond the error of these coarse grids."""
    for bound in (pursuit, cars):
        best, *others = check_by_playing(bound, 150)
        assert best.name == "optimal"
        assert abs(best.mean_error) < 0.01 and best.most < 0.03
        for other in others:
            assert other.above < 0.03, other.name
            assert other.over_bound < best.over_bound - 0.02


def test_no_pursuer_comes_closer_than_the_optimal_one(cars: Bound) -> None:
    starts = draw_starts(cars, 200, 1)
    promised = cars.value(*starts.T)

    def towards(r, a, psi):  # type: ignore[no-untyped-def]
        return np.clip(4.0 * a, -1.0, 1.0)

    kept = play_bound(cars, starts, pursuer=towards)
    assert np.quantile(kept - promised, 0.02) > -0.06
    assert (kept - promised).mean() > 0.0


def test_simulated_games_agree_with_the_kernel(pursuit: Bound) -> None:
    """Moving aside by eq. (4), played twice by independent code."""
    starts = draw_starts(pursuit, 100, 2)
    free = replace(pursuit, game=replace(pursuit.game, evader_turn=1e3))
    here = play_bound(
        free, starts, fixed_angle_evader(pursuit, pi / 2), duration=4.0
    )
    game = make_game(1.0, 1.0, 1.0, 1.0)
    out = play_games(game, starts, 4.0, capture_distance=GRID.near)
    there = np.maximum(out.closest_distance, GRID.near)
    off = np.abs(here - there)
    assert np.quantile(off, 0.95) < 0.01


def test_table_survives_a_round_trip_through_a_file(
    cars: Bound, tmp_path: Path
) -> None:
    path = tmp_path / "cars.npz"
    cars.save(path)
    again = load_bound(path)
    np.testing.assert_array_equal(again.values, cars.values)
    assert replace(again, values=cars.values) == cars
    with np.load(path) as file:
        assert file["evader_turn"].shape == cars.grid.shape
        assert file["pursuer_turn"].shape == cars.grid.shape
    with pytest.raises(ValueError, match="read-only"):
        again.values[0, 0, 0] = 1.0


@pytest.mark.parametrize("content", [b"", b"nonsense", None])
def test_other_files_are_refused(
    content: bytes | None, tmp_path: Path
) -> None:
    path = tmp_path / "bad.npz"
    if content is None:
        np.savez(path, values=np.zeros(3))
    else:
        path.write_bytes(content)
    with pytest.raises(PlanError, match="not a valid table of a bound"):
        load_bound(path)


def test_command_writes_table_and_figure(tmp_path: Path) -> None:
    table, figure = tmp_path / "cars.npz", tmp_path / "cars.png"
    words = "--against any --pursuer-turn 1 --capture 1 --grid 24 --games 50"
    words += f" --output {table} --figure {figure} --json"
    result = CliRunner().invoke(bound_command, words.split())
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["analytic"]["value_error_median_m"] < 0.02
    assert len(found["analytic"]["barrier"]) == 12
    assert 0.0 < found["grid_error_m"] < 0.1
    (row,) = found["refinement"]
    assert found["grid_error_m"] == row["mean_difference_m"]
    assert found["grid_error_95_m"] == row["most_difference_m"]
    assert found["grid_error_worst_m"] == row["worst_difference_m"]
    assert found["grid_error_m"] < found["grid_error_95_m"]
    assert found["grid_error_95_m"] < found["grid_error_worst_m"]
    assert 0.05 < found["grid_error_above_mean_share"] < 0.5
    assert found["horizon_s"] == pytest.approx(2.0 * pi)
    assert found["refinement"][0]["cells"] == 12
    assert found["played"][0]["over_bound"] == pytest.approx(1.0, abs=0.03)
    assert load_bound(table).game == two_car_game(1.0, 1.0, 1.0)
    assert figure.stat().st_size > 10_000


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--capture 0", "capture must lie in"),
        ("--capture 99 --farthest 5 --nearest 1", "--capture"),
        ("--pursuer-speed nan", "--pursuer-speed"),
        ("--output table.txt", ".npz"),
        ("--figure table.txt", "--figure"),
        ("--grid 3", "grid must be an integer"),
    ],
)
def test_bad_options_are_refused(words: str, said: str) -> None:
    result = CliRunner().invoke(main, ["bound", *words.split()])
    assert result.exit_code == 2 and said in result.output
