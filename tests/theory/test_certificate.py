"""Test the certificate and the Lyapunov function behind it."""

from math import pi

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.unicycle.batch import play_games
from stepaside.theory.unicycle.certificate import (
    _largest_spread,
    certify,
    largest_change,
)
from stepaside.theory.unicycle.circles import circle_of
from stepaside.theory.unicycle.unicycle_game import (
    Game,
    RelativeStart,
    make_game,
)

ASIDE = make_game(1.0, 1.0, 1.0, 1.0)
LATCHED = make_game(1.0, 1.0, 1.0, 1.0, side_rule="latched")
SLIM = make_game(1.0, 1.0, 1.0, 1.0, 2.6, side_rule="latched")
WIDE = make_game(0.7, 0.7, 0.4, 0.4, 2.2)


def random_starts(game: Game, count: int, spread: float = pi) -> np.ndarray:
    rng = np.random.default_rng(11)
    unit = game.evader.speed / game.evader.gain
    angles = rng.uniform(-spread, spread, (count, 2))
    return np.column_stack([rng.uniform(0.3, 4.0, count) * unit, angles])


def motion(v: float, r: float, a: float, psi: float) -> tuple[float, float]:
    """Rates of the distance and of the line of sight at equal speeds."""
    return v * (np.cos(psi) - np.cos(a)), v * (np.sin(a) - np.sin(psi)) / r


@pytest.mark.parametrize("game", [ASIDE, LATCHED, WIDE])
def test_no_game_comes_closer_than_certified(game: Game) -> None:
    starts = random_starts(game, 350, 2.0)
    proofs = [certify(game, RelativeStart(*start)) for start in starts]
    held = np.array([proof.holds for proof in proofs])
    bound = np.array([p.distance_m for p in proofs if p.holds])
    duration = 30.0 / game.evader.gain
    step = 0.05 / game.evader.gain
    out = play_games(game, starts[held], duration, step=step)
    assert held.sum() > 30
    assert np.all(out.closest_distance >= bound - 1e-6)
    assert np.all(out.circle == 0)  # and all are on the main circle


def test_no_bound_is_given_where_the_certificate_does_not_hold() -> None:
    starts = random_starts(ASIDE, 200)
    proofs = [certify(ASIDE, RelativeStart(*start)) for start in starts]
    assert 0 < sum(p.holds for p in proofs) < 200
    for proof in proofs:
        shown = proof.distance_m is not None
        assert shown == proof.holds
        assert not shown or proof.distance_m > 0.0  # type: ignore[operator]


def test_sharpened_bound_certifies_more_than_the_plain_one() -> None:
    starts = random_starts(LATCHED, 500)
    proofs = [certify(LATCHED, RelativeStart(*start)) for start in starts]
    held = np.array([p.holds for p in proofs])
    sharp = np.array([p.distance_m for p in proofs if p.holds])
    # The plain bound uses |c(d) - c(0)| <= v |d|.
    r, a, psi = starts[held].T
    side = np.where(psi > 0.0, -1.0, 1.0)
    b = side * psi + LATCHED.angle
    d, x = side * a - b, 0.5 * (side * a + side * psi)
    unit = LATCHED.pursuer.speed / LATCHED.pursuer.gain
    radius = circle_of(LATCHED).distance_m
    plain = radius - abs(r * np.exp(1j * x) - radius) - unit * abs(d)
    assert np.all(sharp >= plain - 1e-9)
    assert len(sharp) > 3 * np.count_nonzero(plain > 0.0) > 60


def test_upper_sum_is_just_above_the_comparison_equation() -> None:
    """The error d falls as e^-t; rho grows at the smaller of two rates."""
    for d0, rho0 in ((1.2, 0.3), (-1.4, 0.2), (-5.0, 0.1), (2.0, 0.0)):
        alpha, radius, h = 1.1, circle_of(make_game(1, 1, 1, 1, 1.1)), 1e-3
        r_star, rho = radius.distance_m, rho0
        for t in np.arange(0.0, 25.0, h) + h / 2:
            d = d0 * np.exp(-t)
            delta = 2 * abs(np.sin((alpha + d) / 2) - np.sin(alpha / 2))
            slow = np.inf
            if rho > 0.0:
                slow = (r_star + rho) * delta**2 / (4 * r_star * rho)
            rho += h * min(delta, slow)
        game = make_game(1, 1, 1, 1, alpha)
        upper = _largest_spread(rho0, d0, game, r_star)
        assert rho - 1e-3 < upper < 1.05 * rho + 1e-3


@pytest.mark.parametrize("alpha", [0.3, pi / 2, 2.9])
def test_largest_change_is_that_of_a_fine_grid(alpha: float) -> None:
    """Also where d < 0 passes the minimum of the sine, at -pi - alpha."""
    rng = np.random.default_rng(1)
    middle = [pi - alpha, -pi - alpha, *rng.uniform(-5.0, 5.0, 20)]
    for center in middle:
        for half in (0.01, 0.3):
            grid = np.linspace(center - half, center + half, 4001)
            fine = np.abs(np.sin((alpha + grid) / 2) - np.sin(alpha / 2))
            found = largest_change(alpha, center - half, center + half)
            assert fine.max() <= found + 1e-15
            assert found == pytest.approx(fine.max(), abs=1e-6)


@pytest.mark.parametrize(
    ("game", "start", "holds"),
    [
        # Positive bounds; the comments say what is missing where not.
        (LATCHED, (1.9, 1.44, -0.27), True),
        (LATCHED, (1.56, 2.45, -2.73), True),  # outside the diamond
        (LATCHED, (2.56, -0.75, -0.07), True),  # by the diamond alone
        (LATCHED, (0.25, 1.97, -2.59), False),  # an error may wrap
        (ASIDE, (1.57, 0.31, -1.05), True),
        (ASIDE, (2.08, 0.2, -1.86), False),  # the side may change
        (ASIDE, (0.85, 3.1, -2.93), False),  # an error may wrap
        (ASIDE, (1.31, 2.4, -0.76), False),  # the side may change
        (SLIM, (1.0, -0.19, -1.88), True),
        (SLIM, (1.45, -0.23, -0.64), False),  # an error may wrap
    ],
)
def test_certificate_needs_unwrapped_errors_and_a_kept_side(
    game: Game, start: tuple[float, float, float], holds: bool
) -> None:
    for sign in (1.0, -1.0):
        r, a, psi = start
        proof = certify(game, RelativeStart(r, sign * a, sign * psi))
        assert proof.holds == holds


def test_no_certificate_where_the_side_may_change_otherwise() -> None:
    start = RelativeStart(1.57, 0.31, -1.05)
    assert certify(ASIDE, start, side=1).holds
    assert not certify(ASIDE, start, side=-1).holds
    loose = make_game(1.0, 1.0, 1.0, 1.0, hysteresis=0.1)
    assert not certify(loose, start).holds
    assert certify(LATCHED, start, side=1).holds


def test_lyapunov_rate_matches_the_proof() -> None:
    """Along the printed law, by the chain rule at random states."""
    rng = np.random.default_rng(5)
    v, k, alpha = 0.8, 0.6, 1.1
    game = make_game(v, v, k, k, alpha)
    radius = circle_of(game).distance_m
    for r, a, b in rng.uniform([0.2, -2, -2], [3, 2, 2], (100, 3)):
        psi = b - alpha
        r_dot, omega = motion(v, r, a, psi)
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
        rate, omega = motion(v, r, a, psi)
        return r * np.array([rate, omega - k * a])

    for r, x in [(0.5, 0.3), (2.0, -1.0), (4.0, 2.0)]:
        by_r = (field(r + h, x)[0] - field(r - h, x)[0]) / (2 * h)
        by_x = (field(r, x + h)[1] - field(r, x - h)[1]) / (2 * h)
        assert by_r + by_x == pytest.approx(-k * r, abs=1e-8)


def test_unequal_players_are_refused() -> None:
    with pytest.raises(PlanError, match="equal speeds and gains"):
        certify(make_game(1.0, 1.1, 1.0, 1.0), RelativeStart(1.0))


def test_bound_has_the_units_of_the_game() -> None:
    """Speed v and gain k scale lengths by v / k."""
    unit, start = 0.7 / 0.4, RelativeStart(1.57, 0.31, -1.05)
    scaled = make_game(0.7, 0.7, 0.4, 0.4)
    big = RelativeStart(1.57 * unit, 0.31, -1.05)
    one, other = certify(ASIDE, start), certify(scaled, big)
    assert one.distance_m is not None and other.distance_m is not None
    assert other.distance_m / unit == pytest.approx(one.distance_m)
