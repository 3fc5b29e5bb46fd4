"""Test cyclic pursuit: polygons, their stability, and games that end there."""

from math import pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stepaside.core.errors import PlanError
from stepaside.theory.unicycle.cyclic_pursuit import CyclicPolygon


def polygon(count: int, density: int = 1, gain: float = 0.5) -> CyclicPolygon:
    return CyclicPolygon(count, density, 1.0, gain)


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


def rates(one: CyclicPolygon, flat: np.ndarray) -> np.ndarray:
    """Rates of all poses in the frame that turns with the polygon."""
    x, y, theta = flat.reshape(-1, 3).T
    aim = np.arctan2(np.roll(y, -1) - y, np.roll(x, -1) - x)
    psi = (aim - theta + pi) % (2 * pi) - pi
    return np.column_stack(
        [
            np.cos(theta) + one.rate * y,
            np.sin(theta) - one.rate * x,
            one.gain * psi - one.rate,
        ]
    ).ravel()


@pytest.mark.parametrize(
    ("count", "density"), [(3, 1), (4, 1), (5, 1), (5, 2), (7, 3)]
)
def test_eigenvalues_agree_with_the_jacobian_of_the_poses(
    count: int, density: int
) -> None:
    """By finite differences of all states, which rest on the polygon."""
    one = polygon(count, density)
    flat = one.poses().ravel()
    np.testing.assert_allclose(rates(one, flat), 0.0, atol=1e-12)
    eps = 1e-6
    columns = [
        (rates(one, flat + eps * e) - rates(one, flat - eps * e)) / (2 * eps)
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
    changes = np.random.default_rng(count).uniform(-0.05, 0.05, (count, 3))
    slowest = -one.eigenvalues()[0].real
    found = solve_ivp(
        lambda _, flat: rates(one, flat),
        (0.0, 18.0 / slowest),
        (one.poses() + changes).ravel(),
        rtol=1e-9,
        atol=1e-9,
    )
    positions = found.y[:, -1].reshape(count, 3)[:, :2]
    sides = np.hypot(*(np.roll(positions, -1, axis=0) - positions).T)
    np.testing.assert_allclose(sides, one.side, rtol=1e-6)
    radii = np.hypot(*(positions - positions.mean(axis=0)).T)
    np.testing.assert_allclose(radii, one.radius, rtol=1e-6)


@pytest.mark.parametrize("values", [(1, 1), (3, 0), (3, 3)])
def test_a_polygon_needs_players_and_a_density(
    values: tuple[int, int],
) -> None:
    with pytest.raises(PlanError, match="density must lie between 0 and"):
        CyclicPolygon(*values, 1.0, 0.5)
