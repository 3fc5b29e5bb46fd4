"""Test cyclic pursuit: polygons, their stability, and games that end there.

Each of n unicycles of unit speed and gain turns at the bearing of the next
one. In an equilibrium they are a regular polygon {n/d} on one circle (J. A.
Marshall, M. E. Broucke and B. A. Francis, "Formations of vehicles in cyclic
pursuit", IEEE Transactions on Automatic Control 49, 2004).
"""

from math import pi, sin, sqrt, tau

import numpy as np
import pytest
from scipy.integrate import solve_ivp


def eigenvalues(count: int, density: int) -> np.ndarray:
    """Eigenvalues of the linearised shape, the slowest first.

    In the frame that turns with the polygon the linearisation is block
    circulant, with states radial and tangential displacement and heading.
    Those of turning and moving the whole polygon are left out.
    """
    bearing = pi * density / count
    turn = np.exp(2j * bearing)  # from one player to the next
    chord = (turn - 1.0) / bearing
    own, other = 1.0 / chord, turn / chord
    itself = np.array(
        [
            [0.0, bearing, -1.0],
            [-bearing, 0.0, 0.0],
            [-own.imag, -own.real, -1.0],
        ]
    )
    following = np.zeros((3, 3))
    following[2, :2] = other.imag, other.real
    modes = [
        np.linalg.eigvals(itself + np.exp(1j * tau * m / count) * following)
        for m in range(count)
    ]
    for mode, turns in ((0, 0), (density, 1), (-density, -1)):
        nearest = np.abs(modes[mode] - 1j * turns * bearing).argmin()
        modes[mode] = np.delete(modes[mode], nearest)
    found = np.concatenate(modes)
    return found[np.argsort(-found.real)]


def poses(count: int, density: int = 1) -> np.ndarray:
    angles = tau * density * np.arange(count) / count
    place = np.column_stack([np.cos(angles), np.sin(angles)])
    radius = count / (pi * density)
    return np.column_stack([radius * place, angles + pi / 2])


def rates(rate: float, flat: np.ndarray) -> np.ndarray:
    """Rates of all poses in the frame that turns with the polygon."""
    x, y, theta = flat.reshape(-1, 3).T
    aim = np.arctan2(np.roll(y, -1) - y, np.roll(x, -1) - x)
    psi = (aim - theta + pi) % (2 * pi) - pi
    columns = np.cos(theta) + rate * y, np.sin(theta) - rate * x, psi - rate
    return np.column_stack(columns).ravel()


def test_for_two_it_is_the_papers_game_with_the_angle_pi() -> None:
    """Eigenvalues -k and k / 2 (-1 +- sqrt(1 - pi^2)) of theory."""
    root = 1j * sqrt(pi**2 - 1.0)
    found = eigenvalues(2, 1)
    assert len(found) == 3
    for value in (-1.0, 0.5 * (-1 + root), 0.5 * (-1 - root)):
        assert np.abs(found - value).min() < 1e-12


@pytest.mark.parametrize(
    ("count", "density"), [(3, 1), (4, 1), (5, 1), (5, 2), (7, 3)]
)
def test_eigenvalues_agree_with_the_jacobian_of_the_poses(
    count: int, density: int
) -> None:
    """By finite differences of all states, which rest on the polygon."""
    flat, rate = poses(count, density).ravel(), pi * density / count
    np.testing.assert_allclose(rates(rate, flat), 0.0, atol=1e-12)
    eps = 1e-6
    columns = [
        (rates(rate, flat + eps * e) - rates(rate, flat - eps * e)) / 2 / eps
        for e in np.eye(3 * count)
    ]
    every = np.linalg.eigvals(np.array(columns).T)
    found = eigenvalues(count, density)
    for value in (*found, 0.0, 1j * rate, -1j * rate):
        assert np.abs(every - value).min() < 1e-6
    assert len(every) == len(found) + 3


def test_convex_polygons_are_stable_and_dense_stars_are_not() -> None:
    stable = {
        (n, d)
        for n in range(2, 10)
        for d in range(1, n)
        if eigenvalues(n, d)[0].real < -1e-9
    }
    assert {(n, 1) for n in range(2, 10)} <= stable
    assert not {(6, 3), (7, 3), (8, 3), (3, 2), (5, 4)} & stable
    assert all(2 * d <= n for n, d in stable)


@pytest.mark.parametrize("count", [3, 7])
def test_games_that_begin_near_a_stable_polygon_end_on_it(count: int) -> None:
    changes = np.random.default_rng(count).uniform(-0.05, 0.05, (count, 3))
    slowest = -eigenvalues(count, 1)[0].real
    found = solve_ivp(
        lambda _, flat: rates(pi / count, flat),
        (0.0, 18.0 / slowest),
        (poses(count) + changes).ravel(),
        rtol=1e-9,
        atol=1e-9,
    )
    positions = found.y[:, -1].reshape(count, 3)[:, :2]
    sides = np.hypot(*(np.roll(positions, -1, axis=0) - positions).T)
    radius = count / pi
    np.testing.assert_allclose(sides, 2 * radius * sin(pi / count), rtol=1e-6)
    radii = np.hypot(*(positions - positions.mean(axis=0)).T)
    np.testing.assert_allclose(radii, radius, rtol=1e-6)
