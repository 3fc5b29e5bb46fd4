"""Games with a faster pursuer that never settle, by an own integrator."""

from math import cos, pi, sin, tau
from typing import NamedTuple

import numpy as np
import pytest

from stepaside.theory.unicycle.adaptive_simulation import simulate
from stepaside.theory.unicycle.all_circles import circles_of
from stepaside.theory.unicycle.basins import random_starts
from stepaside.theory.unicycle.kernel import play_games
from stepaside.theory.unicycle.relative_coordinates import RelativeStart
from stepaside.theory.unicycle.unicycle_game import Game, make_game

State = tuple[float, float, float]
# Speeds, gains and angle; a start; distances that it stays between.
NO_CIRCLE = make_game(1.7651, 0.43, 2.0897, 1.0674, 1.3004)
ONE_CIRCLE = make_game(0.8831, 0.7117, 0.4482, 0.7551, 2.1371)
COUNTEREXAMPLES = [
    (NO_CIRCLE, (0.6049, -0.4196, 1.4271), (0.1506, 0.9964)),
    (ONE_CIRCLE, (0.943, -1.911, -0.219), (0.1614, 0.8259)),
]


class Played(NamedTuple):
    """State at the end; times of changes of side; least, largest r late."""

    state: State
    changes: list[float]
    least: float
    largest: float


def rates(game: Game, state: State, side: int) -> State:
    """The model of docs/unicycles.md, law (4)."""
    r, a, psi = state
    vp, ve = game.pursuer.speed, game.evader.speed
    sight = (vp * sin(a) - ve * sin(psi)) / r
    error = psi + side * game.angle
    turn = game.evader.gain * error
    return (
        ve * cos(psi) - vp * cos(a),
        sight - game.pursuer.gain * a,
        sight - turn,
    )


def stepped(game: Game, state: State, side: int, h: float) -> State:
    """One step of Runge and Kutta's rule."""

    def at(slope: State, share: float) -> State:
        r, a, psi = (
            s + share * h * k for s, k in zip(state, slope, strict=True)
        )
        return r, a, psi

    k1 = rates(game, state, side)
    k2 = rates(game, at(k1, 0.5), side)
    k3 = rates(game, at(k2, 0.5), side)
    k4 = rates(game, at(k3, 1.0), side)
    r, a, psi = (
        s + h / 6.0 * (p + 2.0 * q + 2.0 * u + w)
        for s, p, q, u, w in zip(state, k1, k2, k3, k4, strict=True)
    )
    return r, a, psi


def integrate(
    game: Game, start: State, duration: float, step: float = 0.02
) -> Played:
    """Play with the side behind; cut steps where it or a wrap changes."""
    state, side, now = start, -1 if start[2] > 0.0 else 1, 0.0
    changes: list[float] = []
    least, largest = np.inf, 0.0
    speed = game.pursuer.speed + game.evader.speed

    def beyond(there: State) -> bool:
        return not (abs(there[1]) <= pi and 0.0 <= -side * there[2] <= pi)

    while now < duration - 1e-12:
        h = min(step, 0.1 * state[0] / speed, duration - now)
        after = stepped(game, state, side, h)
        if beyond(after):
            low, high = 0.0, h
            for _ in range(50):
                middle = 0.5 * (low + high)
                if beyond(stepped(game, state, side, middle)):
                    high = middle
                else:
                    low = middle
            h, after = high, stepped(game, state, side, high)
        now += h
        r, a, psi = after
        a, psi = (x - tau * round(x / tau) for x in (a, psi))
        behind = -1 if psi > 0.0 else 1
        if behind != side:
            changes.append(now)
        state, side = (r, a, psi), behind
        if now > 0.5 * duration:
            least, largest = min(least, r), max(largest, r)
    return Played(state, changes, least, largest)


@pytest.mark.parametrize(("game", "start", "between"), COUNTEREXAMPLES)
def test_side_may_change_without_end_against_a_faster_pursuer(
    game: Game, start: State, between: tuple[float, float]
) -> None:
    """As a motion between two distances, which neither end nor settle."""
    assert game.pursuer.speed > game.evader.speed
    played = integrate(game, start, 120.0)
    assert (played.least, played.largest) == pytest.approx(between, abs=2e-4)
    gaps = np.diff([time for time in played.changes if time > 60.0])
    assert len(gaps) > 15 and gaps.max() < 6.0
    out = play_games(game, [start], 120.0, step=0.02, capture_distance=1e-6)
    assert not out.captured[0] and out.circle[0] == -1
    run = simulate(game, RelativeStart(*start), 30.0)
    first = integrate(game, start, 30.0)
    np.testing.assert_allclose(
        run.states([30.0])[0, 0], first.state[0], atol=1e-5
    )
    pairs = zip(run.sides, run.sides[1:], strict=False)
    assert sum(a != b for a, b in pairs) == len(first.changes)


def test_one_counterexample_has_no_circle_and_one_has_a_stable_circle() -> (
    None
):
    assert not circles_of(NO_CIRCLE)
    (circle,) = circles_of(ONE_CIRCLE)
    assert circle.stable and circle.behind
    near = (circle.distance_m, circle.pursuer_error_rad, circle.bearing_rad)
    out = play_games(ONE_CIRCLE, [near], 20.0)
    assert out.circle[0] == 0


def test_without_a_stable_circle_the_side_changes_without_end() -> None:
    """Games of the parameter box of docs/unicycles.md."""
    rng = np.random.default_rng(5)
    found = 0
    while found < 5:
        vp, ve, kp, ke = np.exp(rng.uniform(-0.9, 0.9, 4)).tolist()
        game = make_game(vp, ve, kp, ke, float(rng.uniform(0.05, 3.0)))
        held = any(circle.stable for circle in circles_of(game))
        if game.pursuer.speed < game.evader.speed or held:
            continue
        found += 1
        slow = min(game.pursuer.gain, game.evader.gain)
        starts = random_starts(game, 2, seed=found)
        out = play_games(game, starts, 100.0 / slow, capture_distance=1e-9)
        assert not out.captured.any() and (out.circle == -1).all()
        for r, a, psi in out.states.tolist():
            played = integrate(game, (r, a, psi), 20.0 / slow)
            assert len(played.changes) > 2
            assert played.changes[-1] > 10.0 / slow
