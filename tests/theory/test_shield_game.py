"""Test the sampled game of the shield."""

from dataclasses import replace
from functools import cache
from math import pi, tau

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.core.poses import Array
from stepaside.theory.value import (
    PoseGrid,
    ShieldGame,
    ShieldTable,
    solve_game,
    solve_shield,
    sub_poses,
)
from stepaside.theory.value.chauffeur import guaranteed_distance

SPEED = 0.6  # of the robot, by that of the person
PERIOD = 0.25  # in turning radii per speed of the person
CLOSED = guaranteed_distance(SPEED)
pytestmark = pytest.mark.slow  # tables of seconds


def omnidirectional(loss: float = 0.0, speed: float = SPEED) -> ShieldGame:
    """Return the game of a point against a person of unit speed and radius."""
    angles = tau / 16 * np.arange(16)
    twists = [(speed * np.cos(a), speed * np.sin(a), 0.0) for a in angles]
    motions = sub_poses([*twists, (0.0, 0.0, 0.0)], PERIOD)
    return ShieldGame(1.0, 1.0, motions, PERIOD, loss)


@cache
def solved(share: float, loss: float = 0.0) -> ShieldTable:
    """Return the table for a share of the closed form."""
    game = omnidirectional(loss)
    return solve_shield(
        game, share * CLOSED, cells=4, headings=8, response=0.05
    )


def test_distances_below_the_closed_form_can_be_kept_and_above_not() -> None:
    assert solved(0.75).outside > 0.0
    assert solved(1.15).outside == 0.0


def test_losses_per_decision_cost_speed() -> None:
    """A distance that is safe without losses is not with them."""
    assert solved(0.75, loss=0.5 * SPEED * PERIOD).outside == 0.0


def test_value_is_at_most_the_distance_and_mirrored() -> None:
    table = solved(0.75)
    random = np.random.default_rng(3)
    poses = random.uniform([-0.4, -0.4, -pi], [1.0, 0.4, pi], (300, 3))
    values = table.value(poses)
    assert (values <= np.hypot(poses[:, 0], poses[:, 1]) + 1e-12).all()
    np.testing.assert_allclose(
        values, table.value(poses * [1.0, -1.0, -1.0]), atol=1e-9
    )


def test_mirrored_starts_are_worth_the_same() -> None:
    """A start to the left, past a person on the right, is not one to it."""
    table, random = solved(0.75), np.random.default_rng(4)
    motions = table.game.motions
    mirror = [
        int(np.abs(motions - motion * [1.0, -1.0, -1.0]).sum((1, 2)).argmin())
        for motion in motions
    ]
    for pose in random.uniform([0.1, -0.3, -pi], [0.4, 0.3, pi], (50, 3)):
        found = table.best_starts(pose)
        other = table.best_starts(pose * [1.0, -1.0, -1.0])
        np.testing.assert_allclose(found, other[mirror], atol=1e-9)
        # The motion alone is at least as good, up to interpolation.
        cell = table.grid.spacing
        assert (found <= table.outcomes(pose, motions, PERIOD) + cell).all()


def test_safe_states_have_a_motion_after_which_they_are_safe() -> None:
    """The step of the induction, against walks between those of the grid."""
    table, random = solved(0.75), np.random.default_rng(5)
    required = 0.75 * CLOSED
    poses = random.uniform([-0.3, -0.4, -pi], [0.9, 0.4, pi], (400, 3))
    safe = poses[table.value(poses) >= required]
    assert len(safe) > 50
    found = [
        table.outcomes(pose, table.game.motions, PERIOD).max() for pose in safe
    ]
    # Values between nodes are interpolated: half a cell of error.
    assert min(found) > required - 0.5 * table.grid.spacing


@cache
def lossy() -> ShieldTable:
    """Return the table of a fast robot, of large losses and responses."""
    angles = tau / 8 * np.arange(8)
    twists = [(1.6 * np.cos(a), 1.6 * np.sin(a), 0.0) for a in angles]
    motions = sub_poses(twists, PERIOD)
    game = ShieldGame(1.0, 4.0, motions, PERIOD, 0.05, 0.04)
    return solve_shield(
        game, 0.3, cells=4, headings=12, response=0.2, wait=0.05
    )


def walked(
    pose: Array, motion: Array, duration: float, random: np.random.Generator
) -> tuple[Array, Array]:
    """Return poses after walks between those of the grid, and on the way.

    Args:
        pose: Pose of the robot in the frame of the person.
        motion: Its poses in its own frame. Shape (parts, 3).
        duration: Duration, in [s].
        random: Source of the walks.
    """
    most = [1.0, 0.0, 0.25]  # of a radius of 4
    twists = random.uniform(-1.0, 1.0, (20, 3)) * most
    twists[:8] = [(1.0, 0.0, w) for w in np.linspace(-0.25, 0.25, 8)]
    twists[:, 0] = np.abs(twists[:, 0])
    c, s = np.cos(pose[2]), np.sin(pose[2])
    own = pose[:2] + motion[:, :2] @ [[c, s], [-s, c]]
    walks = sub_poses(twists, duration)
    way = own - walks[:, :, :2]
    c, s = np.cos(walks[:, -1, 2]), np.sin(walks[:, -1, 2])
    x, y = way[:, -1].T
    turned = pose[2] + motion[-1, 2] - walks[:, -1, 2]
    return np.stack([c * x + s * y, c * y - s * x, turned], axis=1), way


def displaced(poses: Array, radius: float) -> Array:
    """Return poses displaced in 16 directions. Shape (16 n, 3)."""
    angles = tau / 16 * np.arange(16)
    ring = radius * np.stack(
        [np.cos(angles), np.sin(angles), 0.0 * angles], axis=1
    )
    return (poses[:, None] + ring).reshape(-1, 3)


def test_values_hold_against_every_walk_and_displacement() -> None:
    """Equations (1) and (2) of docs/shield-proof.md, and its rule of halts.

    Values between nodes are interpolated.
    """
    cells = {"motion": 0.5, "start": 0.15, "stand": 0.15, "halt": 0.15}
    cells["begin"] = 0.75  # interpolated at both ends
    table, random = lossy(), np.random.default_rng(8)
    game, still = table.game, np.zeros((4, 3))
    assert table.outside > 0.0
    poses = random.uniform([-0.5, -0.6, -pi], [0.9, 0.6, pi], (200, 3))
    excess: dict[str, list[float]] = {}

    def check(name: str, found: float, least: float, way: Array) -> None:
        least = min(least, np.hypot(way[..., 0], way[..., 1]).min())
        excess.setdefault(name, []).append(found - least)

    for pose in poses:
        number = random.integers(len(game.motions))
        motion = game.motions[number]
        later, way = walked(pose, motion, PERIOD, random)
        value = table.value(displaced(later, 0.05 + 0.04)).min()
        found = table.outcomes(pose, motion[None], PERIOD)[0]
        check("motion", found, value, way)
        # The motion begins after the response of 0.2, or half of it.
        for part in (0.1, 0.2):
            lost = displaced(walked(pose, still, part, random)[0], 0.05 * 0.8)
            begin = lost[random.integers(len(lost))]
            later, way = walked(begin, motion, PERIOD, random)
            value = table.value(displaced(later, 0.05 + 0.04)).min()
            found = table.start_outcomes(pose, motion[None], PERIOD)[0]
            check("start", found, value, way)
            check("begin", table.best_starts(pose)[number], value, way)
        # A robot that stands on starts after the wait of 0.05.
        later, way = walked(pose, still, 0.05, random)
        later = displaced(later, 0.01 + 0.04)
        value = min(table.best_starts(each).max() for each in later)
        check("stand", table.standing_value(pose)[0], value, way)
        # It halts in 0.6, within 0.1.
        later, way = walked(pose, still, 0.6, random)
        value = table.standing_value(displaced(later, 0.12 + 0.1)).min()
        check("halt", table.halting_value(pose, 0.6, 0.1), value, way)
    for name, each in excess.items():
        assert max(each) < cells[name] * table.grid.spacing, name


def test_a_value_pays_for_the_losses_of_every_decision() -> None:
    """It is at most that of the best motion, within a layer of safe states."""
    table, random = lossy(), np.random.default_rng(8)
    poses = random.uniform([-0.5, -0.6, -pi], [0.9, 0.6, pi], (300, 3))
    motions = table.game.motions
    best = [table.outcomes(pose, motions, PERIOD).max() for pose in poses]
    excess = (table.value(poses) - best).max()
    assert excess < 0.02 * table.grid.spacing


def test_a_start_pays_for_every_place_within_its_loss() -> None:
    """A cliff of the values is charged five cells before it, not six."""
    motion = sub_poses([(0.0, 0.0, 0.0)], 1.0)
    game = ShieldGame(1e-6, 1.0, motion, 1.0, loss=0.5)
    grid = PoseGrid(5.0, 0.1, 41, 11, 8)
    values = np.ones(grid.shape)
    values[20:] = 0.0  # from x = 7 m on
    starts = np.zeros((0, *grid.whole().shape))
    walking = solve_game(motion, motion, grid, outside=lambda _: 0.0)
    walking = replace(
        walking, values=values, after=values, grid=grid._replace(outside=1.0)
    )
    table = ShieldTable(game, walking, values, starts, 1.0, 0.0)
    for x, least in ((6.4, 1.0), (6.5, 0.0), (6.9, 0.0)):
        (found,) = table.start_outcomes((x, 0.3, 0.5), motion, 1.0)
        assert (found > 0.5) == (least > 0.5), (x, found)


@pytest.mark.parametrize("least", [0.0, -0.2, float("nan")])
def test_required_distance_that_is_not_positive_is_refused(
    least: float,
) -> None:
    with pytest.raises(PlanError, match="least must be finite and > 0"):
        solve_shield(omnidirectional(), least)
