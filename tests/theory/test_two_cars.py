"""Test games of two cars: closed form, laws, simulated games, files."""

from dataclasses import replace
from functools import cache
from math import pi, tau
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from played_values import Player, by_table, play, towards
from stepaside.core.errors import PlanError
from stepaside.theory.unicycle import Unicycles, play_games
from stepaside.theory.value import (
    CarGame,
    PoseGrid,
    ValueTable,
    load_table,
    solve_cars,
)
from stepaside.theory.value.outcomes import cubic_cell, look_up_all
from stepaside.theory.value.two_cars import (
    barrier_poses,
    barrier_slice,
    car_poses,
)

Array = NDArray[np.float64]
PURSUIT = CarGame(1.0, 1.0, pursuer_gain=1.0)
CARS = CarGame(1.0, 1.0, pursuer_turn=1.0)
SLOW = pytest.mark.slow


@cache
def pursuit() -> ValueTable:
    return solve_cars(PURSUIT, 3.4, 24)


@cache
def cars(cells: int = 30) -> ValueTable:
    return solve_cars(CARS, 6.0, cells)


@pytest.mark.parametrize(
    "capture", [0.5, *(pytest.param(x, marks=SLOW) for x in (1.0, 2.0))]
)
def test_the_barrier_is_that_of_the_closed_form(capture: float) -> None:
    """Every piece, both halves: a few hundredths of a cell of 0.12 radii.

    That is the table of 24 mm for cars of 0.1 m/s and 0.5 rad/s.
    """
    table = solve_cars(CARS, 4.8, 40)
    poses, pieces = barrier_poses(capture)
    np.testing.assert_array_equal(CARS.barrier(capture), poses)
    inside = np.hypot(poses[:, 0], poses[:, 1]) < 4.5
    off = np.abs(table.offsets(poses[inside], capture))
    assert table.grid.spacing == pytest.approx(0.12)
    assert off.mean() < 1.5e-3 / 0.2 and np.quantile(off, 0.95) < 5.5e-3 / 0.2
    for piece in (1, 2, 3):
        assert off[np.abs(pieces[inside]) == piece].mean() < 0.025


def test_the_reach_is_that_of_a_head_on_capture() -> None:
    points, _ = barrier_slice(1.0, pi)
    nose = np.hypot(*points.T).max()
    assert cars().reach(1.0) == pytest.approx(nose, abs=0.3)


def step_back(game: CarGame, table: ValueTable, time: float) -> Array:
    """One step of the equation of the value, written independently.

    Both choose among a few turning rates, and states move along straight
    lines in the pursuer's frame.
    """
    x, y, theta = np.meshgrid(*table.grid.axes(), indexing="ij")
    best = np.full(x.shape, np.inf)
    for free in np.linspace(-1.0, 1.0, 5 if game.pursuer_turn else 1):
        turn = game.pursuer_turn * free
        turn = turn + game.pursuer_gain * np.arctan2(y, x)
        moved = [
            np.stack(
                [
                    x + time * (np.cos(theta) - 1.0 + turn * y),
                    y + time * (np.sin(theta) - turn * x),
                    theta + time * (turn_e - turn),
                ],
                axis=-1,
            )
            for turn_e in game.evader_turn * np.linspace(-1.0, 1.0, 5)
        ]
        kept = np.max([table.value(poses) for poses in moved], axis=0)
        best = np.minimum(best, kept)
    least: Array = np.minimum(best, np.hypot(x, y))
    return least


@pytest.mark.parametrize("game", [PURSUIT, CARS], ids=["pursuit", "cars"])
def test_values_fulfil_their_equation(game: CarGame) -> None:
    table = pursuit() if game is PURSUIT else cars()
    time = 0.5 * table.grid.spacing
    inside = table.grid.distances(np.inf) < 2.5
    weaker = replace(game, evader_turn=0.8 * game.evader_turn)
    off, short = (
        (step_back(each, table, time) - table.values)[inside] / time
        for each in (game, weaker)
    )
    # Values change by up to two per unit of time.
    assert np.abs(off).mean() < 0.05 and off.mean() > -0.03
    assert short.mean() < -0.06


def law(time: float) -> Player:
    """Return the pursuer of eq. (2), which holds its turn for a time."""

    def steer(poses: Array) -> Array:
        aim = np.arctan2(poses[:, 1], poses[:, 0])
        turn = aim * (1.0 - np.exp(-time)) / time
        return np.column_stack([np.ones_like(aim), 0.0 * aim, turn])

    return steer


def drawn(near: float, far: float, count: int = 200) -> Array:
    """Distances, bearings of the evader and of the pursuer."""
    low, high = [near, -pi, -pi], [far, pi, pi]
    return np.random.default_rng(0).uniform(low, high, (count, 3))


@pytest.mark.parametrize("game", [PURSUIT, CARS], ids=["pursuit", "cars"])
def test_optimal_evader_reaches_the_value_of_the_table(game: CarGame) -> None:
    table = pursuit() if game is PURSUIT else cars()
    held, starts = (
        game.period(table.grid.spacing),
        car_poses(*drawn(0.3, 2.5).T),
    )
    pursuer = by_table(table, game.pursuer_twists, 1)
    off = table.value(starts) - play(
        starts,
        by_table(table, game.evader_twists, 0),
        law(held / 8) if game is PURSUIT else pursuer,
        period=held,
        duration=tau,
        reacts=game is PURSUIT,
    )
    assert abs(off.mean()) < 0.01 and np.quantile(np.abs(off), 0.95) < 0.03


@pytest.mark.parametrize("angle", [0.0, pi / 4, pi / 2])
def test_no_evader_keeps_more_than_the_table(angle: float) -> None:
    """Evaders of eq. (4) against eqs. (1)-(2), by another integrator."""
    states = drawn(0.3, 2.5)
    game = Unicycles(1.0, 1.0, 1.0, 1.0, angle)
    closest = play_games(game, states, tau).closest_distance
    bound = pursuit().value(car_poses(*states.T))
    assert (closest - bound).max() < 0.05
    assert closest.mean() < 0.98 * bound.mean()


def test_no_pursuer_comes_closer_than_the_optimal_one() -> None:
    table, starts = cars(), car_poses(*drawn(0.5, 4.0).T)
    held = CARS.period(table.grid.spacing)
    closest = play(
        starts,
        by_table(table, CARS.evader_twists, 0),
        towards(held / 8),
        period=held,
        duration=tau,
        reacts=True,
    )
    assert (closest - table.value(starts)).min() > -0.1


def test_values_are_mirrored_and_periodic() -> None:
    poses = car_poses(*drawn(0.5, 5.0).T)
    here = cars().value(poses)
    np.testing.assert_allclose(cars().value(poses * [1, -1, -1]), here)
    np.testing.assert_allclose(cars().value(poses + [0, 0, tau]), here)


def test_pursuer_turns_towards_and_evader_away() -> None:
    """Evader to the left: turn left; pursuer on its left: turn right."""
    table = cars()

    def turns(r: float, a: float, psi: float) -> tuple[float, float]:
        own, other = table.decisions(car_poses(r, a, psi))
        return CARS.evader_twists[own, 2], CARS.pursuer_twists[other, 2]

    assert turns(2.0, 1.0, 0.0)[1] == pytest.approx(1.0)
    assert turns(2.0, -1.0, 0.0)[1] == pytest.approx(-1.0)
    assert turns(2.0, 0.0, 1.0)[0] == pytest.approx(1.0)
    assert turns(2.0, 0.0, -1.0)[0] == pytest.approx(-1.0)
    # The evader is behind: the closest approach has passed.
    assert turns(2.0, 2.5, 0.3)[1] == pytest.approx(1.0)


def test_lengths_scale_with_speed_over_gain() -> None:
    """NAO's 0.1 m/s and 0.2 1/s are the same game at half the size."""
    small = solve_cars(CarGame(0.1, 0.1, pursuer_gain=0.2), 1.7, 24)
    np.testing.assert_allclose(2 * small.values, pursuit().values, atol=2e-3)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: CarGame(1.0, 1.0, float("nan")), "pursuer_gain"),
        (lambda: CarGame(1.0, 1.0, 0.0, 0.0, 1.0), "pursuer_turn"),
        (lambda: CarGame(1.0, -1.0, 0.0, 1.0), "evader_speed"),
        (lambda: replace(CARS, pursuer_gain=1.0), "pursuer_turn"),
        (lambda: solve_cars(CARS, 3.0, 16, horizon=-1.0), "horizon"),
        (lambda: solve_cars(CARS, 3.0, 4), "cells"),
        (lambda: solve_cars(CARS, float("inf"), 16), "far"),
    ],
)
def test_bad_values_are_refused_by_name(make: Any, words: str) -> None:
    with pytest.raises(PlanError, match=words):
        make()


def test_saved_table_is_read_back(tmp_path: Path) -> None:
    table = pursuit()
    table.save(tmp_path / "table.npz")
    again = load_table(tmp_path / "table.npz")
    poses = car_poses(*drawn(0.5, 4.0, 50).T)
    np.testing.assert_array_equal(again.value(poses), table.value(poses))
    np.testing.assert_array_equal(
        again.best_motion(poses), table.best_motion(poses)
    )
    assert again.grid == table.grid


@pytest.mark.parametrize("damage", ["missing", "empty", "cut", "other"])
def test_unreadable_table_is_refused_in_one_line(
    damage: str, tmp_path: Path
) -> None:
    path = tmp_path / "table.npz"
    if damage == "cut":
        solve_cars(PURSUIT, 3.4, 8).save(path)
        path.write_bytes(path.read_bytes()[:-500])
    elif damage == "other":
        np.savez(path, values=np.zeros(3))
    elif damage == "empty":
        path.touch()
    with pytest.raises(PlanError, match="not a valid table of a game") as why:
        load_table(path)
    assert "\n" not in str(why.value)


def test_cars_are_identical_by_speed_and_turn() -> None:
    assert CARS.identical
    assert not replace(CARS, evader_speed=0.9).identical
    assert not replace(CARS, evader_turn=0.9).identical


def test_cubics_of_a_cell_reproduce_a_plane() -> None:
    grid = PoseGrid(0.0, 1.0, 6, 6, 1, right=-2.0)
    x, y, _ = grid.axes()
    values = (2.0 * x[:, None] - 3.0 * y)[:, :, None]
    for s, t in ((0.0, 0.0), (0.3, 0.7), (0.9, 0.2)):
        found = cubic_cell(values, 2, 2, s, t, grid)
        assert found == pytest.approx(2.0 * (2.0 + s) - 3.0 * t)


@pytest.mark.parametrize("name", ["pursuer_speed", "evader_speed"])
def test_unicycles_that_stand_are_refused(name: str) -> None:
    speeds: Any = {"pursuer_speed": 1.0, "evader_speed": 1.0, name: 0.0}
    with pytest.raises(PlanError, match=f"{name} must be finite and > 0"):
        Unicycles(**speeds, pursuer_gain=1.0, evader_gain=1.0)


@pytest.mark.parametrize("cubic", [False, True])
def test_half_a_table_is_read_as_the_whole(cubic: bool) -> None:
    """Right of the axis, values are those of the mirror image; also beyond."""
    half = PoseGrid.covering(0.5, 2.0, 1.0, 1.5, headings=1 if cubic else 8)
    half = half._replace(cubic=cubic)
    generator = np.random.default_rng(1)
    values = generator.random(half.shape)
    values[:, 0] += np.roll(values[:, 0, ::-1], 1, axis=1)
    back = np.roll(values[:, :0:-1, ::-1], 1, axis=2)
    whole = np.concatenate([back, values], axis=1)
    poses = generator.uniform(-2.2, 2.2, (400, 3))
    found = np.zeros((2, 400))
    look_up_all(values, poses, half, found[0])
    look_up_all(whole, poses, half.whole(), found[1])
    np.testing.assert_allclose(found[0], found[1], atol=1e-12)
