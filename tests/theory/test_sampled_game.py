"""Test games with held turning rates and the stability of their circle."""

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.unicycle.adaptive_simulation import simulate
from stepaside.theory.unicycle.circles import circle_of
from stepaside.theory.unicycle.relative_coordinates import RelativeStart
from stepaside.theory.unicycle.sampled_game import (
    choose_turning,
    simulate_sampled,
)
from stepaside.theory.unicycle.sampled_stability import (
    delayed_eigenvalues,
    largest_stable_delay,
    largest_stable_sample_time,
    step_eigenvalues,
    step_map,
)
from stepaside.theory.unicycle.unicycle_game import Game, make_game

NAO = make_game(0.1, 0.1, 0.2, 0.2)
UNEVEN = make_game(0.9, 1.0, 0.4, 0.7, 1.1)


def on_circle(game: Game = NAO) -> np.ndarray:
    circle = circle_of(game)
    bearing = circle.evader_error_rad - game.angle
    return np.array([circle.distance_m, circle.pursuer_error_rad, bearing])


@pytest.mark.parametrize("game", [NAO, UNEVEN])
@pytest.mark.parametrize("delay", [0.0, 0.3, 1.7])
def test_sampling_and_delay_do_not_change_the_circle(
    game: Game, delay: float
) -> None:
    run = simulate_sampled(game, RelativeStart(*on_circle(game)), 0.4, 0.4)
    np.testing.assert_allclose(run.states[-1], on_circle(game), atol=1e-12)
    far = RelativeStart(1.3 * on_circle(game)[0], -0.5, 0.6)
    run = simulate_sampled(game, far, 200.0, 0.4, delay=delay)
    np.testing.assert_allclose(
        np.abs(run.states[-1]), np.abs(on_circle(game)), atol=1e-5
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
    run = simulate_sampled(UNEVEN, start, 60.0, period, delay=delay)
    seen = 0
    for n in range(depth, len(run.turning_rates)):
        pipe = run.turning_rates[n - depth : n][::-1] - rate
        now = np.concatenate([run.states[n] - rest, pipe.ravel()])
        size = np.abs(now).max()
        if not 1e-5 < size < 0.05:
            continue
        seen += 1
        then = run.states[n + 1] - rest
        assert np.abs((matrix @ now)[:3] - then).max() < 4.0 * size**2
        chosen = run.turning_rates[n] - rate
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
        run = simulate_sampled(
            UNEVEN, start, 200 * limit, factor * limit, delay=delay
        )
        spreads.append(np.abs(run.states[-1] - on_circle(UNEVEN)).max())
    assert spreads[0] < 1e-4 < spreads[1]


def test_largest_delay_has_an_eigenvalue_on_the_axis() -> None:
    limit = largest_stable_delay(NAO)
    value = delayed_eigenvalues(NAO, limit)[0]
    assert abs(value.real) < 1e-9
    fine = largest_stable_delay(NAO, 0.25)
    assert fine == pytest.approx(limit - 0.125, abs=0.02)
    assert limit == pytest.approx(5.0 * largest_stable_delay_unit(), rel=1e-9)


def largest_stable_delay_unit() -> float:
    return largest_stable_delay(make_game(1.0, 1.0, 1.0, 1.0))


def test_sampled_game_tends_to_the_continuous_one() -> None:
    start = RelativeStart(2.0, 0.4, -0.3)
    exact = simulate(UNEVEN, start, 10.0)
    state = exact.states([10.0])[0, :3]
    errors = []
    for period in (0.02, 0.01):
        run = simulate_sampled(UNEVEN, start, 10.0, period)
        errors.append(np.abs(run.states[-1] - state).max())
    assert errors[1] < 0.02
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.2)


def test_side_follows_the_rule_with_its_hysteresis() -> None:
    game = make_game(1, 1, 1, 1, hysteresis=0.2)
    assert choose_turning(game, RelativeStart(1.0, 0.0, 0.1), 1)[2] == 1
    assert choose_turning(game, RelativeStart(1.0, 0.0, 0.3), 1)[2] == -1
    assert choose_turning(game, RelativeStart(1.0, 0.0, -0.3), -1)[2] == 1
    assert choose_turning(game, RelativeStart(1.0, 0.0, 0.1), 0)[2] == -1
    kept = make_game(1, 1, 1, 1, side_rule="latched")
    assert choose_turning(kept, RelativeStart(1.0, 0.0, 2.0), 1)[2] == 1


def test_no_linearisation_for_a_sliding_evader_or_without_a_circle() -> None:
    with pytest.raises(PlanError, match="slides"):
        step_map(make_game(1, 1, 1, 1, 0.3, "saturated"), 0.1)
    with pytest.raises(PlanError, match="no circle"):
        step_map(make_game(1, 1, 1, 1, 0.0), 0.1)


def test_equal_players_tolerate_sampling_of_1_7_and_delay_of_1_1() -> None:
    """In units of 1/k, at an angle of pi / 2."""
    assert 0.2 * largest_stable_sample_time(NAO) == pytest.approx(
        1.70, abs=0.005
    )
    assert 0.2 * largest_stable_delay(NAO) == pytest.approx(1.10, abs=0.005)


def test_game_ends_with_the_period_of_its_capture() -> None:
    """They drive head on: at speeds of 2 and 1 forward and away."""
    game = make_game(2.0, 1.0, 0.5, 0.5, 0.0)
    run = simulate_sampled(
        game, RelativeStart(1.0), 10.0, 0.32, capture_distance=0.5
    )
    assert run.captured and len(run.times) == 3
    assert run.closest_distance == pytest.approx(0.36)
    at_once = simulate_sampled(
        game, RelativeStart(0.5), 1.0, 0.1, capture_distance=1
    )
    assert at_once.captured and at_once.times.tolist() == [0.0]
    assert at_once.turning_rates.shape == (0, 2)


def test_perception_takes_effect_when_its_delay_is_over() -> None:
    """Until then both drive straight on, and so does a late first rate."""
    start = RelativeStart(3.0, 0.5, -0.2)
    for delay in (0.3, 0.4, 1.1):
        run = simulate_sampled(NAO, start, 4.0, 0.4, delay=delay)
        rate_p, rate_e = run.turning_rates[0]
        done = int(delay / 0.4 + 1e-9)
        assert run.pursuer[done, 2] == run.evader[done, 2] - run.evader[0, 2]
        turned = 0.4 * (done + 1) - delay
        heading = run.pursuer[done + 1, 2] - run.pursuer[0, 2]
        assert heading == pytest.approx(rate_p * turned)
        heading = run.evader[done + 1, 2] - run.evader[0, 2]
        assert heading == pytest.approx(rate_e * turned)


def test_held_rates_are_those_of_the_laws() -> None:
    game = make_game(1.0, 1.0, 0.5, 0.7, 1.1)
    got = choose_turning(game, RelativeStart(1.0, 0.3, -0.4), 0)
    assert got == pytest.approx((0.15, 0.7 * 0.7, 1))
    hard = make_game(1.0, 1.0, 0.5, 0.7, 1.1, "saturated")
    got = choose_turning(hard, RelativeStart(1.0, -0.3, 1.2), 0)
    assert got == pytest.approx((-0.15, 0.7, -1))
    wide = make_game(1.0, 1.0, 0.5, 0.7, 2.0, side_rule="latched")
    rate = choose_turning(wide, RelativeStart(1.0, 0.0, 3.0), 1)[1]
    assert rate == pytest.approx(0.7 * (5.0 - 2.0 * np.pi))


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("duration", {"duration": 0.0}),
        ("sample_time", {"sample_time": 0.0}),
        ("delay", {"delay": -0.1}),
        ("capture_distance", {"capture_distance": 0.0}),
    ],
)
def test_values_out_of_range_are_refused_by_name(
    name: str, options: dict[str, float]
) -> None:
    values = {"duration": 1.0, "sample_time": 0.1} | options
    with pytest.raises(PlanError, match=f"^{name} must"):
        simulate_sampled(NAO, RelativeStart(1.0), **values)
