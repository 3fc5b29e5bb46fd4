"""Test games of several unicycles: laws, backends and the game of two."""

from math import pi

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.teams.compiled_team import (
    MOST_SWEPT,
    small_arc_tangent,
)
from stepaside.theory.teams.team_game import play_team_games
from stepaside.theory.teams.team_players import TeamPlayer
from stepaside.theory.unicycle import make_game, play_games

PURSUER = TeamPlayer(1.0, 0.5)
EVADER = TeamPlayer(1.0, 0.5, evades=True)


def starts_of(games: int, count: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    poses = rng.uniform(-4.0, 4.0, (games, count, 3))
    poses[:, :, 2] = rng.uniform(-pi, pi, (games, count))
    return poses


def test_a_game_of_two_is_that_of_the_relative_coordinates() -> None:
    """The kernel of two locates edges within a step, this one does not."""
    rng = np.random.default_rng(1)
    r = rng.uniform(1.0, 5.0, 60)
    a, psi = rng.uniform(-1.0, 1.0, (2, 60))
    known = play_games(
        make_game(1.0, 1.0, 0.5, 0.5), np.column_stack([r, a, psi]), 30.0
    )
    poses = np.zeros((60, 2, 3))
    poses[:, 0, 2] = -a
    poses[:, 1, 0] = r
    poses[:, 1, 2] = pi - psi
    out = play_team_games([PURSUER, EVADER], poses, 30.0)
    np.testing.assert_allclose(
        out.closest[:, 0, 1], known.closest_distance, atol=2e-3
    )
    apart = out.poses[:, 1, :2] - out.poses[:, 0, :2]
    np.testing.assert_allclose(
        np.hypot(*apart.T), known.states[:, 0], atol=1e-3
    )


@pytest.mark.parametrize("count", [2, 3, 5])
def test_compiled_and_array_games_agree(count: int) -> None:
    pytest.importorskip("numba")
    players = [PURSUER] * (count - 1) + [EVADER]
    starts = starts_of(70, count)
    one, other = (
        play_team_games(players, starts, 4.0, backend=backend)
        for backend in ("numba", "numpy")
    )
    np.testing.assert_allclose(one.closest, other.closest, atol=1e-9)
    np.testing.assert_allclose(one.poses, other.poses, atol=1e-9)


def test_the_series_of_a_swept_angle_is_exact() -> None:
    tangents = np.linspace(-MOST_SWEPT, MOST_SWEPT, 1001)
    found = [small_arc_tangent(t) for t in tangents.tolist()]
    np.testing.assert_allclose(found, np.arctan(tangents), rtol=4e-16)


def test_an_evader_turns_from_the_nearest_pursuer() -> None:
    """A far second pursuer changes nothing until it is the nearer one."""
    poses = np.array(
        [[[-1.0, 0.3, 0.0], [50.0, 0.0, pi], [0.0, 0.0, pi + 0.2]]]
    )
    both = play_team_games([PURSUER, PURSUER, EVADER], poses, 5.0)
    alone = play_team_games([PURSUER, EVADER], poses[:, [0, 2]], 5.0)
    np.testing.assert_allclose(
        both.poses[0, [0, 2]], alone.poses[0], atol=1e-9
    )


def test_players_that_are_mirrored_play_the_mirrored_game() -> None:
    players = [PURSUER, TeamPlayer(0.8, 1.0), EVADER]
    starts = starts_of(20, 3, seed=4)
    mirror = np.array([1.0, -1.0, -1.0])
    out = play_team_games(players, starts, 6.0)
    again = play_team_games(players, starts * mirror, 6.0)
    np.testing.assert_allclose(again.poses, out.poses * mirror, atol=1e-6)
    np.testing.assert_allclose(again.closest, out.closest, atol=1e-6)


def test_closest_approaches_are_symmetric_and_of_the_whole_game() -> None:
    starts = starts_of(10, 3)
    out = play_team_games([PURSUER, PURSUER, EVADER], starts, 3.0)
    np.testing.assert_array_equal(out.closest, out.closest.transpose(0, 2, 1))
    assert np.isinf(out.closest[:, range(3), range(3)]).all()
    for i, j in ((0, 1), (0, 2), (1, 2)):
        first = np.hypot(*(starts[:, i, :2] - starts[:, j, :2]).T)
        last = np.hypot(*(out.poses[:, i, :2] - out.poses[:, j, :2]).T)
        bound = np.minimum(first, last) + 1e-12
        assert (out.closest[:, i, j] <= bound).all()
    np.testing.assert_array_equal(
        out.closest_to(2, [0, 1]), out.closest[:, 2, :2].min(axis=1)
    )


@pytest.mark.parametrize(
    ("players", "message"),
    [
        ([PURSUER], "players must be 2 to 16, got 1"),
        ([PURSUER, PURSUER], "player 0 must have an opponent"),
        ([PURSUER, TeamPlayer(1.0, 1.0, target=5)], "must be another player"),
        ([PURSUER, TeamPlayer(1.0, 1.0, target=1)], "must be another player"),
    ],
)
def test_bad_teams_are_refused(
    players: list[TeamPlayer], message: str
) -> None:
    with pytest.raises(PlanError, match=message):
        play_team_games(players, np.zeros((1, len(players), 3)), 1.0)


def test_bad_starts_are_refused() -> None:
    team = [PURSUER, EVADER]
    with pytest.raises(PlanError, match=r"starts must have shape \(games, 2"):
        play_team_games(team, np.zeros((3, 3)), 1.0)
    with pytest.raises(PlanError, match="starts must be finite"):
        play_team_games(team, np.full((1, 2, 3), np.nan), 1.0)
    with pytest.raises(PlanError, match="backend must be"):
        play_team_games(team, np.zeros((1, 2, 3)), 1.0, backend="c")
