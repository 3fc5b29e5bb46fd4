"""Test the certificate and the Lyapunov function behind it."""

from math import pi

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.certificate import certify
from stepaside.theory.unicycle.circles import circle_of
from stepaside.theory.unicycle.simulation import play_games

ASIDE = Unicycles(1.0, 1.0, 1.0, 1.0)
LATCHED = Unicycles(1.0, 1.0, 1.0, 1.0, side_rule="latched")
SLIM = Unicycles(1.0, 1.0, 1.0, 1.0, 2.6, side_rule="latched")
WIDE = Unicycles(0.7, 0.7, 0.4, 0.4, 2.2)


def random_starts(
    game: Unicycles, count: int, spread: float = pi
) -> np.ndarray:
    rng = np.random.default_rng(11)
    unit = game.evader_speed / game.evader_gain
    angles = rng.uniform(-spread, spread, (count, 2))
    return np.column_stack([rng.uniform(0.3, 4.0, count) * unit, angles])


def certified(game: Unicycles, starts: np.ndarray) -> np.ndarray:
    """Return the bounds of games from starts, NaN where none is proved."""
    found = [certify(game, RelativeStart(*start)) for start in starts]
    return np.array(found, dtype=np.float64)


@pytest.mark.parametrize(
    "game",
    [
        WIDE,
        *(pytest.param(g, marks=pytest.mark.slow) for g in (ASIDE, LATCHED)),
    ],
)
def test_no_game_comes_closer_than_certified(game: Unicycles) -> None:
    starts = random_starts(game, 350, 2.0)
    bound = certified(game, starts)
    held = np.isfinite(bound)
    duration = 30.0 / game.evader_gain
    step = 0.05 / game.evader_gain
    out = play_games(game, starts[held], duration, step=step)
    assert held.sum() > 30
    assert np.all(out.closest_distance >= bound[held] - 1e-6)
    assert np.all(out.circle == 0)  # and all are on the main circle


def test_no_bound_is_given_where_the_certificate_does_not_hold() -> None:
    starts = random_starts(ASIDE, 200)
    bound = certified(ASIDE, starts)
    assert 0 < np.isfinite(bound).sum() < 200
    assert (bound[np.isfinite(bound)] > 0.0).all()


@pytest.mark.slow
def test_sharpened_bound_certifies_more_than_the_plain_one() -> None:
    starts = random_starts(LATCHED, 500)
    sharp = certified(LATCHED, starts)
    held = np.isfinite(sharp)
    sharp = sharp[held]
    # The plain bound uses |c(d) - c(0)| <= v |d|.
    r, a, psi = starts[held].T
    side = np.where(psi > 0.0, -1.0, 1.0)
    b = side * psi + LATCHED.angle
    d, x = side * a - b, 0.5 * (side * a + side * psi)
    unit = LATCHED.pursuer_speed / LATCHED.pursuer_gain
    radius = circle_of(LATCHED).distance_m
    plain = radius - abs(r * np.exp(1j * x) - radius) - unit * abs(d)
    assert np.all(sharp >= plain - 1e-9)
    assert len(sharp) > 3 * np.count_nonzero(plain > 0.0) > 60


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
    game: Unicycles, start: tuple[float, float, float], holds: bool
) -> None:
    for sign in (1.0, -1.0):
        r, a, psi = start
        proof = certify(game, RelativeStart(r, sign * a, sign * psi))
        assert (proof is not None) == holds


def test_no_certificate_where_the_side_may_change_otherwise() -> None:
    start = RelativeStart(1.57, 0.31, -1.05)
    assert certify(ASIDE, start, side=1) is not None
    assert certify(ASIDE, start, side=-1) is None
    loose = Unicycles(1.0, 1.0, 1.0, 1.0, hysteresis=0.1)
    assert certify(loose, start) is None
    assert certify(LATCHED, start, side=1) is not None


def test_unequal_players_are_refused() -> None:
    with pytest.raises(PlanError, match="equal speeds and gains"):
        certify(Unicycles(1.0, 1.1, 1.0, 1.0), RelativeStart(1.0))


def test_bound_has_the_units_of_the_game() -> None:
    """Speed v and gain k scale lengths by v / k."""
    unit, start = 0.7 / 0.4, RelativeStart(1.57, 0.31, -1.05)
    scaled = Unicycles(0.7, 0.7, 0.4, 0.4)
    big = RelativeStart(1.57 * unit, 0.31, -1.05)
    one, other = certify(ASIDE, start), certify(scaled, big)
    assert one is not None and other is not None
    assert other / unit == pytest.approx(one)
