"""Test the certificate and the Lyapunov function behind it."""

from math import pi

import numpy as np
import pytest

from stepaside.errors import PlanError
from stepaside.unicycle.certificate import certify
from stepaside.unicycle.circling import circle_of
from stepaside.unicycle.kernel import play_games
from stepaside.unicycle.laws import Game, make_game
from stepaside.unicycle.relative import Start

ASIDE = make_game(1.0, 1.0, 1.0, 1.0)
LATCHED = make_game(1.0, 1.0, 1.0, 1.0, side_rule="latched")
WIDE = make_game(0.7, 0.7, 0.4, 0.4, 2.2)


def random_starts(game: Game, count: int, spread: float = pi) -> np.ndarray:
    rng = np.random.default_rng(11)
    unit = game.evader.speed / game.evader.gain
    angles = rng.uniform(-spread, spread, (count, 2))
    return np.column_stack([rng.uniform(0.3, 4.0, count) * unit, angles])


@pytest.mark.parametrize("game", [ASIDE, LATCHED, WIDE])
def test_no_game_comes_closer_than_certified(game: Game) -> None:
    starts = random_starts(game, 2500, 2.0)
    proofs = [certify(game, Start(*start)) for start in starts]
    held = np.array([proof.holds for proof in proofs])
    bound = np.array([proof.distance_m for proof in proofs])
    duration = 40.0 / game.evader.gain
    out = play_games(game, starts[held], duration, step=0.02)
    assert held.sum() > 100
    assert np.all(out.closest_distance >= bound[held] - 1e-9)
    assert np.isfinite(out.settled_time).all()  # and all are on the circle


def test_sharpened_bound_certifies_more_than_the_plain_one() -> None:
    starts = random_starts(LATCHED, 2000)
    proofs = [certify(LATCHED, Start(*start)) for start in starts]
    plain = np.mean([p.plain_distance_m > 0.0 for p in proofs])
    sharp = np.mean([p.holds for p in proofs])
    assert all(p.distance_m >= p.plain_distance_m - 1e-9 for p in proofs)
    assert 0.05 < plain < 0.12
    assert sharp > 3.0 * plain


def test_bound_is_tight_on_the_circle() -> None:
    circle = circle_of(ASIDE)
    proof = certify(ASIDE, Start(circle.distance_m, pi / 4, -pi / 4))
    assert proof.holds
    assert proof.distance_m == pytest.approx(circle.distance_m, abs=1e-5)


def test_lyapunov_rate_is_the_one_of_the_proof() -> None:
    """Along the printed law, by the chain rule at random states."""
    rng = np.random.default_rng(5)
    v, k, alpha = 0.8, 0.6, 1.1
    game = make_game(v, v, k, k, alpha)
    radius = circle_of(game).distance_m
    for r, a, b in rng.uniform([0.2, -2, -2], [3, 2, 2], (100, 3)):
        psi = b - alpha
        omega = v * (np.sin(a) - np.sin(psi)) / r
        r_dot = v * (np.cos(psi) - np.cos(a))
        a_dot, b_dot = omega - k * a, omega - k * b
        d, x = a - b, 0.5 * (a + b - alpha)
        z = r * np.exp(1j * x)
        turn = 0.5 * (a_dot + b_dot)
        z_dot = (r_dot + 1j * r * turn) * np.exp(1j * x)
        rate = (np.conj(z - radius) * z_dot).real
        change = 2 * v * (np.sin((alpha + d) / 2) - np.sin(alpha / 2))
        expected = r * np.sin(x) * (change - k * radius * x)
        assert rate == pytest.approx(expected, abs=1e-12)
        assert a_dot - b_dot == pytest.approx(-k * d, abs=1e-12)


def test_dulac_function_has_a_divergence_of_one_sign() -> None:
    """On d = 0: divergence of r (r', x') is -k r, so nothing is periodic."""
    v, k, alpha, h = 1.0, 0.5, 1.3, 1e-5

    def field(r: float, x: float) -> np.ndarray:
        a = x + alpha / 2
        psi = a - alpha
        omega = v * (np.sin(a) - np.sin(psi)) / r
        rate = v * (np.cos(psi) - np.cos(a))
        return r * np.array([rate, omega - k * a])

    for r, x in [(0.5, 0.3), (2.0, -1.0), (4.0, 2.0)]:
        by_r = (field(r + h, x)[0] - field(r - h, x)[0]) / (2 * h)
        by_x = (field(r, x + h)[1] - field(r, x - h)[1]) / (2 * h)
        assert by_r + by_x == pytest.approx(-k * r, abs=1e-8)


def test_other_games_are_refused() -> None:
    with pytest.raises(PlanError, match="equal speeds and gains"):
        certify(make_game(1.0, 1.1, 1.0, 1.0), Start(1.0))
