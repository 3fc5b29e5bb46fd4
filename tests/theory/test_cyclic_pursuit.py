"""Test cyclic pursuit: polygons, their stability, and games that end there."""

from math import pi, sin, sqrt

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.teams.cyclic_pursuit import CyclicPolygon
from stepaside.theory.teams.team_game import play_team_games
from stepaside.theory.teams.team_players import TeamPlayer


def cycle(
    count: int, speed: float = 1.0, gain: float = 0.5
) -> list[TeamPlayer]:
    return [
        TeamPlayer(speed, gain, target=(i + 1) % count) for i in range(count)
    ]


def polygon(count: int, density: int = 1, gain: float = 0.5) -> CyclicPolygon:
    return CyclicPolygon(count, density, 1.0, gain)


@pytest.mark.parametrize(
    ("count", "density"), [(2, 1), (3, 1), (5, 2), (7, 3)]
)
def test_a_polygon_turns_without_changing_its_shape(
    count: int, density: int
) -> None:
    one = polygon(count, density)
    duration = 0.3
    out = play_team_games(
        cycle(count), one.poses()[None], duration, step=0.01, backend="numpy"
    )
    turn = one.rate * duration
    spun = one.poses()
    c, s = np.cos(turn), np.sin(turn)
    spun[:, :2] = spun[:, :2] @ np.array([[c, s], [-s, c]])
    spun[:, 2] += turn
    np.testing.assert_allclose(out.poses[0], spun, atol=1e-9)


def test_for_two_it_is_the_papers_game_with_the_angle_pi() -> None:
    """Eigenvalues -k and k / 2 (-1 +- sqrt(1 - pi^2)) of theory."""
    pair = polygon(2)
    assert pair.radius == pytest.approx(2.0 * 1.0 / (0.5 * pi))
    assert pair.side == pytest.approx(4.0 * sin(pi / 2) / (0.5 * pi))
    root = 1j * sqrt(pi**2 - 1.0)
    expected = [-0.5, 0.25 * (-1 + root), 0.25 * (-1 - root)]
    found = pair.eigenvalues()
    assert len(found) == 3
    for value in expected:
        assert np.abs(found - value).min() < 1e-12


@pytest.mark.parametrize("count", [3, 4, 5])
def test_eigenvalues_agree_with_the_jacobian_of_the_poses(count: int) -> None:
    """In the frame that turns, by finite differences of all states."""
    one = polygon(count)
    poses = one.poses()

    def rates(flat: np.ndarray) -> np.ndarray:
        x, y, theta = flat.reshape(count, 3).T
        aim = np.arctan2(np.roll(y, -1) - y, np.roll(x, -1) - x)
        psi = (aim - theta + pi) % (2 * pi) - pi
        return np.column_stack(
            [
                np.cos(theta) + one.rate * y,
                np.sin(theta) - one.rate * x,
                0.5 * psi - one.rate,
            ]
        ).ravel()

    flat = poses.ravel()
    np.testing.assert_allclose(rates(flat), 0.0, atol=1e-12)
    eps = 1e-6
    columns = [
        (rates(flat + eps * e) - rates(flat - eps * e)) / (2 * eps)
        for e in np.eye(3 * count)
    ]
    every = np.linalg.eigvals(np.array(columns).T)
    for value in one.eigenvalues():
        assert np.abs(every - value).min() < 1e-6
    for neutral in (0.0, 1j * one.rate, -1j * one.rate):
        assert np.abs(every - neutral).min() < 1e-6
    assert len(every) == len(one.eigenvalues()) + 3


def test_convex_polygons_are_stable_and_dense_stars_are_not() -> None:
    stable = {
        (n, d)
        for n in range(2, 10)
        for d in range(1, n)
        if polygon(n, d).is_stable
    }
    assert {(n, 1) for n in range(2, 10)} <= stable
    assert not {(6, 3), (7, 3), (8, 3), (3, 2), (5, 4)} & stable
    assert all(2 * d <= n for n, d in stable)
    # The gain scales time only.
    for n, d in ((3, 1), (7, 1), (6, 3)):
        quick, slow = (
            np.sort_complex(polygon(n, d, gain=k).eigenvalues().round(9) / k)
            for k in (2.0, 0.5)
        )
        np.testing.assert_allclose(quick, slow, atol=1e-8)


@pytest.mark.parametrize("count", [3, 7])
def test_games_that_begin_near_a_stable_polygon_end_on_it(count: int) -> None:
    one = polygon(count)
    rng = np.random.default_rng(count)
    starts = one.poses() + rng.uniform(-0.05, 0.05, (8, count, 3))
    slowest = -one.eigenvalues()[0].real
    out = play_team_games(cycle(count), starts, 18.0 / slowest)
    positions = out.poses[:, :, :2]
    sides = np.hypot(
        *np.moveaxis(np.roll(positions, -1, axis=1) - positions, 2, 0)
    )
    np.testing.assert_allclose(sides, one.side, rtol=1e-6)
    centre = positions.mean(axis=1, keepdims=True)
    radii = np.hypot(*np.moveaxis(positions - centre, 2, 0))
    np.testing.assert_allclose(radii, one.radius, rtol=1e-6)


def test_games_leave_an_unstable_polygon() -> None:
    one = polygon(5, 4)
    starts = one.poses() + np.random.default_rng(1).uniform(
        -0.01, 0.01, (4, 5, 3)
    )
    growth = one.eigenvalues()[0].real
    assert growth > 0.0
    out = play_team_games(cycle(5), starts, 12.0 / growth)
    positions = out.poses[:, :, :2]
    sides = np.hypot(
        *np.moveaxis(np.roll(positions, -1, axis=1) - positions, 2, 0)
    )
    assert (np.abs(sides / one.side - 1.0).max(axis=1) > 0.05).all()


@pytest.mark.parametrize("values", [(1, 1), (3, 0), (3, 3)])
def test_a_polygon_needs_players_and_a_density(
    values: tuple[int, int],
) -> None:
    with pytest.raises(PlanError, match="density must lie between 0 and"):
        CyclicPolygon(*values, 1.0, 0.5)
