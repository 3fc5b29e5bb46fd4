"""Test one game against the circle, symmetry and a plain integration."""

from math import atan2, hypot, pi, remainder, tau

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.core.poses import Pose
from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.circles import circle_of
from stepaside.theory.unicycle.simulation import PlayedGame, simulate

GAMES = [
    Unicycles(1.0, 1.0, 0.5, 0.5),
    Unicycles(1.0, 1.0, 0.5, 0.5, pi / 2, "saturated"),
    Unicycles(1.0, 1.0, 0.5, 0.5, 0.3, "saturated"),
    Unicycles(1.0, 1.0, 0.5, 0.5, 0.1),
    Unicycles(1.2, 1.0, 0.5, 0.7, 1.2),
    Unicycles(1.1, 1.0, 0.4, 0.7, 0.8, "saturated"),
]


def last_state(run: PlayedGame) -> np.ndarray:
    state: np.ndarray = run.states([run.end_time])[0]
    return state


@pytest.mark.parametrize("game", GAMES)
def test_game_ends_on_the_circle_in_closed_form(game: Unicycles) -> None:
    circle = circle_of(game)
    duration = 60.0 + 14.0 * circle.time_constant_s
    run = simulate(game, RelativeStart(5.0, 0.2, -0.4), duration)
    r, a, psi, *_ = last_state(run)
    assert r == pytest.approx(circle.distance_m, abs=2e-5)
    assert a == pytest.approx(circle.pursuer_error_rad, abs=2e-5)
    assert psi == pytest.approx(circle.evader_error_rad - game.angle, abs=2e-5)


@pytest.mark.parametrize("game", GAMES)
def test_mirrored_start_mirrors_the_game(game: Unicycles) -> None:
    times = np.linspace(0.0, 20.0, 30)
    left = simulate(game, RelativeStart(3.0, 0.5, 1.1), 20.0).states(times)
    right = simulate(game, RelativeStart(3.0, -0.5, -1.1), 20.0).states(times)
    np.testing.assert_allclose(right * [1, -1, -1, -1, 1, -1], left, atol=1e-7)


def plain_world_game(
    game: Unicycles, pursuer: Pose, evader: Pose, duration: float, count: int
) -> tuple[Pose, Pose]:
    """Integrate eqs. (1)-(6) on the floor by Euler's rule, as they stand."""
    h = duration / count
    (x, y, theta), (u, v, phi) = pursuer, evader
    vp, ve = game.pursuer_speed, game.evader_speed
    for _ in range(count):
        aim = atan2(v - y, u - x)
        bearing = remainder(aim + pi - phi, tau)
        side = -1.0 if bearing > 0.0 else 1.0
        error = remainder(aim + side * game.angle - phi - pi + pi + pi, tau)
        turn = game.evader_gain * (np.sign(error) if game.saturated else error)
        x, y = x + h * vp * np.cos(theta), y + h * vp * np.sin(theta)
        u, v = u - h * ve * np.cos(phi), v - h * ve * np.sin(phi)
        theta += h * game.pursuer_gain * remainder(aim - theta, tau)
        phi += h * turn
    return Pose(x, y, theta), Pose(u, v, phi)


@pytest.mark.parametrize("game", GAMES)
def test_game_agrees_with_the_printed_equations_on_the_floor(
    game: Unicycles,
) -> None:
    """Also where the saturated law slides: Euler chatters to the same."""
    pursuer, evader = Pose(0.0, 0.0, 0.0), Pose(2.5, 1.0, 3.3)
    start = RelativeStart.from_world(pursuer, evader)
    run = simulate(game, start, 6.0)
    p, e = plain_world_game(game, pursuer, evader, 6.0, 12000)
    ours_p, ours_e = run.poses([6.0])
    assert hypot(*(ours_p[0, :2] - p[:2])) < 4e-3
    assert hypot(*(ours_e[0, :2] - e[:2])) < 4e-3


def test_sliding_evader_keeps_the_angle_exactly() -> None:
    game = GAMES[2]
    run = simulate(game, RelativeStart(5.0, 0.2, 0.4), 40.0)
    assert len(run.switches) == 1  # onto the line, and no chatter
    times = np.linspace(run.switches[0] + 1e-9, 40.0, 50)
    np.testing.assert_allclose(run.states(times)[:, 2], 0.3, atol=1e-12)


def test_sliding_ends_where_the_line_of_sight_outruns_the_evader() -> None:
    game = Unicycles(1.0, 1.0, 5.0, 0.3, 0.5, "saturated")
    run = simulate(game, RelativeStart(6.0, 0.0, -0.5), 40.0)
    times = np.linspace(0.0, run.end_time, 4000)
    states = run.states(times)
    sliding = np.abs(states[:, 2] + 0.5) < 1e-12
    assert sliding[0] and not sliding[-1]
    rate = (np.sin(states[:, 1]) - np.sin(states[:, 2])) / states[:, 0]
    assert np.abs(rate[sliding]).max() <= 0.3 + 1e-9


def test_capture_is_an_event_at_the_given_distance() -> None:
    game = Unicycles(1.0, 1.0, 0.5, 0.5, pi)
    run = simulate(
        game, RelativeStart(3.0, 0.0, pi), 10.0, capture_distance=0.4
    )
    assert run.captured
    assert run.end_time == pytest.approx(1.3, abs=1e-9)  # they walk head on
    assert last_state(run)[0] == pytest.approx(0.4)


def test_fixed_side_has_a_reversed_circle_that_the_side_rule_removes() -> None:
    """Errors wrap, so a kept side can circle the wrong way round."""
    error = pi / 4 - pi
    start = RelativeStart(1.0, error + 0.05, error - pi / 2 + 0.03)
    fixed = Unicycles(1, 1, 0.5, 0.5, side_rule="latched")
    run = simulate(fixed, start, 80.0, side=1)
    r, a, psi, *_ = last_state(run)
    assert a == pytest.approx(error, abs=1e-6)
    omega = (np.sin(a) - np.sin(psi)) / r
    assert abs(1.0 / omega) == pytest.approx(1 / (0.5 * 0.75 * pi))
    free = simulate(Unicycles(1, 1, 0.5, 0.5), start, 120.0, side=1)
    assert last_state(free)[0] == pytest.approx(3.6012652646, abs=1e-6)


def test_hysteresis_delays_the_change_of_side() -> None:
    start = RelativeStart(1.5, 1.4, 0.01)
    for width in (0.0, 0.2):
        game = Unicycles(1.0, 0.3, 0.2, 0.2, hysteresis=width)
        run = simulate(game, start, 20.0, side=-1)
        if run.switches:
            psi = run.states([run.switches[0] - 1e-9])[0, 2]
            inside = min(abs(psi + width), abs(psi - pi - width))
            assert inside < 1e-6


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan")])
def test_bad_values_are_refused(value: float) -> None:
    with pytest.raises(PlanError, match="duration must"):
        simulate(GAMES[0], RelativeStart(1.0), value)
    with pytest.raises(PlanError, match="capture_distance must"):
        simulate(GAMES[0], RelativeStart(1.0), 1.0, capture_distance=value)
    with pytest.raises(PlanError, match="^distance must"):
        RelativeStart(value)


def test_side_that_the_rule_forbids_changes_immediately() -> None:
    """Then the game is the one that asks for no side."""
    game, start = (Unicycles(1.0, 1.0, 0.5, 0.5), RelativeStart(3.0, 0.2, 0.8))
    asked = simulate(game, start, 10.0, side=1)
    free = simulate(game, start, 10.0)
    assert asked.switches[0] == 0.0
    assert asked.sides[:2] == (1, -1)
    times = np.linspace(0.0, 10.0, 21)
    np.testing.assert_allclose(
        asked.states(times), free.states(times), atol=1e-9
    )
