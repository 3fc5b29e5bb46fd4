"""Test what a played game is said to end on."""

from math import pi

import numpy as np
import pytest

from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.circles import circles_of, settling_time
from stepaside.theory.unicycle.simulation import measure, play_games, simulate

FAST = Unicycles(2.0, 1.0, 1.0, 4.0)
NO_CIRCLE = Unicycles(1.0, 1.0, 0.5, 2.0, 0.0)


def test_settling_time_waits_for_the_slowest_circle_and_one_turn() -> None:
    circles = circles_of(FAST)
    waits = [
        c.time_constant_s * np.log(1e6) + 2.0 * pi / abs(c.turning_rate_rad_s)
        for c in circles
        if c.stable
    ]
    assert settling_time(FAST) == pytest.approx(30.0 + max(waits))
    assert settling_time(NO_CIRCLE) == pytest.approx(120.0)


def test_circle_is_named_within_two_percent_on_either_side() -> None:
    circles = circles_of(FAST)
    for n, circle in enumerate(circles):
        state = np.array(
            [circle.distance_m, circle.pursuer_error_rad, circle.bearing_rad]
        )
        sizes = np.diag([circle.distance_m, 1.0, 1.0])
        for side in (1, -1):
            for by, found in ((0.0, n), (0.019, n), (0.021, -1)):
                starts = (state + by * sizes) * [1.0, side, side]
                out = play_games(FAST, starts, 1e-6)
                assert (out.circle == found).all()


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
