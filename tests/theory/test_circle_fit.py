"""Test what a played game is said to end on."""

from math import pi

import numpy as np
import pytest

from stepaside.theory.unicycle.adaptive_simulation import simulate
from stepaside.theory.unicycle.circle_fit import (
    circle_at,
    fit_circle,
    measure,
    settling_time,
)
from stepaside.theory.unicycle.circles import circles_of
from stepaside.theory.unicycle.relative_coordinates import RelativeStart
from stepaside.theory.unicycle.unicycle_game import make_game

FAST = make_game(2.0, 1.0, 1.0, 4.0)
NO_CIRCLE = make_game(1.0, 1.0, 0.5, 2.0, 0.0)


def test_settling_time_waits_for_the_slowest_circle_and_one_turn() -> None:
    circles = circles_of(FAST)
    waits = [
        c.time_constant_s * np.log(1e3) + 2.0 * pi / abs(c.turning_rate_rad_s)
        for c in circles
        if c.stable
    ]
    got = settling_time(FAST, precision=1e-3)
    assert got == pytest.approx(30.0 + max(waits))
    part_per_million = settling_time(FAST, precision=1e-6)
    assert settling_time(FAST) == part_per_million > got
    assert settling_time(NO_CIRCLE) == pytest.approx(120.0)


def test_circle_is_named_within_two_percent_on_either_side() -> None:
    circles = circles_of(FAST)
    for circle in circles:
        state = np.array(
            [circle.distance_m, circle.pursuer_error_rad, circle.bearing_rad]
        )
        for side in (1, -1):
            here = state * [1.0, side, side]
            assert circle_at(circles, here, side) == circle
            assert circle_at(circles, here, -side) is None
            for k, size in enumerate((circle.distance_m, 1.0, 1.0)):
                near, far = here.copy(), here.copy()
                near[k] += 0.019 * size
                far[k] += 0.021 * size
                assert circle_at(circles, near, side) == circle
                assert circle_at(circles, far, side) is None


def test_game_without_a_circle_is_measured_over_its_last_tenth() -> None:
    run = simulate(NO_CIRCLE, RelativeStart(3.0, 0.4, 0.3), 20.0)
    seen = measure(run)
    (before, after), _ = run.poses([18.0, 20.0])
    rate = (after[2] - before[2]) / 2.0
    assert seen.turning_rate_rad_s == pytest.approx(rate, abs=1e-9)
    assert seen.headings_apart_rad + seen.motions_apart_rad == pytest.approx(
        pi
    )
    states = run.states([20.0])
    assert seen.distance_m == pytest.approx(states[0, 0])


def test_one_turn_is_measured_where_the_game_is_long_enough() -> None:
    """Else half of the game, if its end is on a circle."""
    main = circles_of(FAST)[0]
    turn = 2.0 * pi / abs(main.turning_rate_rad_s)
    for duration in (2.5 * turn, 1.8 * turn):
        state = (1.01 * main.distance_m, main.pursuer_error_rad)
        run = simulate(FAST, RelativeStart(*state, main.bearing_rad), duration)
        span = min(turn, 0.5 * duration)
        times = np.linspace(duration - span, duration, 361)
        _, radius = fit_circle(run.poses(times)[0][:, :2])
        assert measure(run).radius_pursuer_m == pytest.approx(
            radius, rel=1e-12
        )
