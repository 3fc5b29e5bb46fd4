"""Test where games between equal players are sure to end, and where not."""

from math import pi

import numpy as np
import pytest

from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.certificate import stays_unwrapped
from stepaside.theory.unicycle.circles import circles_of
from stepaside.theory.unicycle.simulation import play_games, simulate

KEPT = Unicycles(1.0, 1.0, 1.0, 1.0, side_rule="latched")


def diamond(count: int, seed: int, near: float, far: float) -> np.ndarray:
    """Starts with |a| + |psi| < pi, some of them in its corners."""
    rng = np.random.default_rng(seed)
    s, t = rng.uniform(-pi, pi, (2, count))
    s[::4], t[::4] = np.sign(s[::4]) * 3.1415, np.sign(t[::4]) * 3.1415
    r = np.exp(rng.uniform(np.log(near), np.log(far), count))
    return np.column_stack([r, (s + t) / 2, (s - t) / 2])


@pytest.mark.parametrize("angle", [0.3, pi / 2, 2.4])
@pytest.mark.parametrize("rule", ["behind", "at random"])
def test_no_game_leaves_the_diamond_for_any_sequence_of_sides(
    rule: str, angle: float
) -> None:
    """The printed law by Runge and Kutta's rule, sides as they please."""
    v, k, h = 0.7, 0.4, 0.01
    rng = np.random.default_rng(2)
    starts = diamond(120, 3, 0.5, 6.0)
    r, a, psi = starts.T.copy()
    bounds = r * np.cos(0.5 * (a + psi)) * np.exp(-k * 8.0)
    x = np.stack([r, a, psi])
    side = np.where(psi > 0.0, -1.0, 1.0)

    def rates(x: np.ndarray) -> np.ndarray:
        r, a, psi = x
        sight = v * (np.sin(a) - np.sin(psi)) / r
        error = psi + side * angle
        closing = v * (np.cos(psi) - np.cos(a))
        return np.stack([closing, sight - k * a, sight - k * error])

    for _ in range(800):
        if rule == "behind":
            side = np.where(x[2] > 0.0, -1.0, 1.0)
        else:
            side = np.where(rng.random(len(r)) < 0.02, -side, side)
        k1 = rates(x)
        k2 = rates(x + h / 2 * k1)
        k3 = rates(x + h / 2 * k2)
        k4 = rates(x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        assert np.all(np.abs(x[1]) + np.abs(x[2]) < pi)
    assert np.all(x[0] >= bounds)
    assert bounds.min() > 0.0


@pytest.mark.parametrize("angle", [0.8, 1.2, pi / 2])
def test_kept_side_ends_on_the_main_circle_from_all_of_the_diamond(
    angle: float,
) -> None:
    game = Unicycles(1.0, 1.0, 1.0, 1.0, angle, side_rule="latched")
    out = play_games(game, diamond(200, 4, 0.05, 5.0), 150.0, step=0.03)
    assert np.all(out.circle == 0)


def test_unwrapped_motion_can_end_on_the_reversed_circle() -> None:
    """|x| < pi is no invariant set: x = -3.14, d = 0 leaves it."""
    error = -3.14 + pi / 4
    start = RelativeStart(0.656, error, error - pi / 2 + 2.0 * pi)
    run = simulate(KEPT, start, 80.0, side=1)
    assert run.switches == ()  # nothing wraps
    circles = circles_of(KEPT)
    assert run.circle == circles[1]
    assert circles[1].direction == -1 and not circles[1].behind
    assert not stays_unwrapped(KEPT, error, start.bearing)


def test_wide_angle_spirals_inward_where_the_side_keeps_changing() -> None:
    """Convergence does not go through changes of side at any angle."""
    game = Unicycles(1.0, 1.0, 1.0, 1.0, 2.2)
    start = RelativeStart(0.051, 1.107, 0.932)
    assert stays_unwrapped(game, -start.pursuer_error, -start.bearing)
    run = simulate(game, start, 6.0)
    assert len(run.switches) > 5 and not run.captured
    moved = Unicycles(1.0, 1.0, 1.0, 1.0, pi / 2)
    ends = [
        play_games(g, [[0.051, 1.107, 0.932]], 20.0, step=0.02).states[0, 0]
        for g in (game, moved)
    ]
    assert ends[0] < 0.01 < 0.05 < ends[1]  # one shrinks, the other grows
    assert ends[0] >= 0.051 * np.cos(0.5 * (1.107 + 0.932)) * np.exp(-20.0)


@pytest.mark.parametrize(
    ("game", "a", "psi", "expected"),
    [
        (KEPT, 1.0, -2.1, True),
        (KEPT, 1.0, -2.2, False),
        (KEPT, -1.1, 1.5, True),
        (KEPT, -1.1, 1.6, False),  # its error is beyond pi
        (Unicycles(1, 1, 1, 1, 2.0, side_rule="latched"), 0.5, -0.5, False),
        (Unicycles(1, 1, 1, 1, 2.0), 0.5, -0.5, True),
    ],
)
def test_starts_proved_not_to_wrap(
    game: Unicycles, a: float, psi: float, expected: bool
) -> None:
    assert stays_unwrapped(game, a, psi) == expected
