"""Test the stability of the circle under sampling and delay."""

import numpy as np
import pytest

from sampled_unicycles import play_sampled
from stepaside.core.errors import PlanError
from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.circles import circle_of
from stepaside.theory.unicycle.sampled_stability import (
    delayed_eigenvalues,
    largest_stable_delay,
    largest_stable_sample_time,
    step_eigenvalues,
    step_map,
)

NAO = Unicycles(0.1, 0.1, 0.2, 0.2)
UNEVEN = Unicycles(0.9, 1.0, 0.4, 0.7, 1.1)


def on_circle(game: Unicycles = NAO) -> np.ndarray:
    circle = circle_of(game)
    bearing = circle.evader_error_rad - game.angle
    return np.array([circle.distance_m, circle.pursuer_error_rad, bearing])


@pytest.mark.parametrize("game", [NAO, UNEVEN])
@pytest.mark.parametrize("delay", [0.0, 0.3, 1.7])
def test_sampling_and_delay_do_not_change_the_circle(
    game: Unicycles, delay: float
) -> None:
    states, *_ = play_sampled(game, RelativeStart(*on_circle(game)), 0.4, 0.4)
    np.testing.assert_allclose(states[-1], on_circle(game), atol=1e-12)
    far = RelativeStart(1.3 * on_circle(game)[0], -0.5, 0.6)
    states, *_ = play_sampled(game, far, 200.0, 0.4, delay)
    np.testing.assert_allclose(
        np.abs(states[-1]), np.abs(on_circle(game)), atol=1e-5
    )


@pytest.mark.parametrize("delay", [0.0, 0.25, 0.5, 1.0, 1.3])
def test_step_map_predicts_the_next_sample_of_a_game(delay: float) -> None:
    """State and the rates chosen before, newest first, near the circle."""
    period = 0.5
    rest = on_circle(UNEVEN)
    rate = circle_of(UNEVEN).turning_rate_rad_s
    matrix = step_map(UNEVEN, period, delay)
    depth = (len(matrix) - 3) // 2
    start = RelativeStart(*(rest + [0.02, -0.01, 0.015]))
    states, rates, *_ = play_sampled(UNEVEN, start, 60.0, period, delay)
    seen = 0
    for n in range(depth, len(rates)):
        pipe = rates[n - depth : n][::-1] - rate
        now = np.concatenate([states[n] - rest, pipe.ravel()])
        size = np.abs(now).max()
        if not 1e-5 < size < 0.05:
            continue
        seen += 1
        then = states[n + 1] - rest
        assert np.abs((matrix @ now)[:3] - then).max() < 4.0 * size**2
        chosen = rates[n] - rate
        np.testing.assert_allclose((matrix @ now)[3:5], chosen, atol=1e-12)
        np.testing.assert_allclose((matrix @ now)[5:], now[3:-2], atol=0)
    assert seen > 5
    values = step_eigenvalues(UNEVEN, period, delay)
    sizes = [abs(value) for value in values]
    assert sizes == sorted(sizes, reverse=True)
    assert len(values) == len(matrix)
    assert sum(values).real == pytest.approx(np.trace(matrix))


def test_short_periods_tend_to_the_continuous_law() -> None:
    period = 1e-3
    slow = max(v.real for v in circle_of(NAO).eigenvalues)
    step = abs(step_eigenvalues(NAO, period)[0])
    assert np.log(step) / period == pytest.approx(slow, rel=1e-3)
    slow = delayed_eigenvalues(NAO, 1.0)[0].real
    step = abs(step_eigenvalues(NAO, 0.01, 0.995)[0])
    assert np.log(step) / 0.01 == pytest.approx(slow, rel=2e-3)


@pytest.mark.parametrize("delay", [0.0, 0.6])
def test_largest_sample_time_separates_decay_from_growth(delay: float) -> None:
    limit = largest_stable_sample_time(UNEVEN, delay)
    start = RelativeStart(*(on_circle(UNEVEN) + [0.0, 1e-4, 0.0]))
    spreads = []
    for factor in (0.93, 1.07):
        period = factor * limit
        states, *_ = play_sampled(UNEVEN, start, 200 * period, period, delay)
        spreads.append(np.abs(states[-1] - on_circle(UNEVEN)).max())
    assert spreads[0] < 1e-4 < spreads[1]


def test_largest_delay_has_an_eigenvalue_on_the_axis() -> None:
    limit = largest_stable_delay(NAO)
    value = delayed_eigenvalues(NAO, limit)[0]
    assert abs(value.real) < 1e-9
    fine = largest_stable_delay(NAO, 0.25)
    assert fine == pytest.approx(limit - 0.125, abs=0.02)
    unit = largest_stable_delay(Unicycles(1.0, 1.0, 1.0, 1.0))
    assert limit == pytest.approx(5.0 * unit, rel=1e-9)


def test_no_linearisation_for_a_sliding_evader_or_without_a_circle() -> None:
    with pytest.raises(PlanError, match="slides"):
        step_map(Unicycles(1, 1, 1, 1, 0.3, "saturated"), 0.1)
    with pytest.raises(PlanError, match="no circle"):
        step_map(Unicycles(1, 1, 1, 1, 0.0), 0.1)


def test_equal_players_tolerate_sampling_of_1_7_and_delay_of_1_1() -> None:
    """In units of 1/k, at an angle of pi / 2."""
    assert 0.2 * largest_stable_sample_time(NAO) == pytest.approx(
        1.70, abs=0.005
    )
    assert 0.2 * largest_stable_delay(NAO) == pytest.approx(1.10, abs=0.005)
