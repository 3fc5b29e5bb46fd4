"""Test the circle of a game against its closed forms."""

from functools import partial
from inspect import signature
from math import cos, inf, nan, pi, sin

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.theory.unicycle.circle_equations import (
    circle_of,
    find_circle,
    imbalance,
)
from stepaside.theory.unicycle.root_finding import sign_changes
from stepaside.theory.unicycle.unicycle_game import TurningLaw, make_game

SATURATED = TurningLaw.SATURATED


def test_circle_of_figure_2() -> None:
    circle = find_circle(1.0, 1.0, 0.5, 0.5, pi / 2)
    assert circle.radius_pursuer_m == pytest.approx(8.0 / pi, rel=1e-12)
    assert circle.distance_m == pytest.approx(3.6012652646, abs=1e-9)
    assert circle.headings_apart_rad == pytest.approx(pi / 2)
    assert circle.time_constant_s == pytest.approx(4.0)


def test_circle_of_the_humanoids() -> None:
    circle = find_circle(0.1, 0.1, 0.2, 0.2)
    assert circle.radius_evader_m == pytest.approx(0.6366197724, abs=1e-9)
    assert circle.distance_m == pytest.approx(0.9003163162, abs=1e-9)
    assert circle.time_constant_s == pytest.approx(10.0)


@pytest.mark.parametrize("alpha", [1e-6, 0.1, 0.9, pi / 2, 2.5, pi])
def test_equal_players_follow_the_closed_form(alpha: float) -> None:
    v, k = 0.7, 0.3
    circle = find_circle(v, v, k, k, alpha)
    assert circle.radius_evader_m == pytest.approx(2 * v / (k * alpha))
    assert circle.distance_m == pytest.approx(
        4 * v * sin(alpha / 2) / (k * alpha), rel=1e-10
    )
    assert circle.motions_apart_rad == pytest.approx(alpha)
    assert circle.headings_apart_rad == pytest.approx(pi - alpha)
    root = np.emath.sqrt(1 - alpha**2)
    expected = [-k, k / 2 * (-1 + root), k / 2 * (-1 - root)]
    np.testing.assert_allclose(
        np.poly(np.array(circle.eigenvalues)),  # coefficients: no order
        np.poly(np.array(expected)),
        atol=1e-9,
    )
    assert circle.stable


def test_radius_grows_without_bound_towards_move_back() -> None:
    angles = np.linspace(pi, 1e-3, 50)
    radii = [find_circle(1, 1, 1, 1, a).radius_pursuer_m for a in angles]
    assert np.all(np.diff(radii) > 0.0)
    assert not find_circle(1, 1, 1, 1, 0.0).exists


def test_saturated_circle_at_full_rate() -> None:
    circle = find_circle(1, 1, 1, 1, pi / 2, SATURATED)
    assert circle.radius_pursuer_m == pytest.approx(1.0)
    assert circle.distance_m == pytest.approx(2 * sin(1.0))
    assert circle.headings_apart_rad == pytest.approx(pi - 2.0)
    np.testing.assert_allclose(
        circle.eigenvalues,
        [-0.2668 + 1.0005j, -0.2668 - 1.0005j, -0.4663],
        atol=1e-4,
    )
    assert not circle.sliding


@pytest.mark.parametrize("alpha", [0.05, 0.3, 0.99])
def test_saturated_circle_slides_below_one_radian(alpha: float) -> None:
    v, k = 0.4, 0.6
    circle = find_circle(v, v, k, k, alpha, "saturated")
    assert circle.sliding and circle.stable
    assert circle.radius_pursuer_m == pytest.approx(v / (k * alpha))
    assert circle.distance_m == pytest.approx(2 * v * sin(alpha) / (k * alpha))


def test_saturated_radius_is_smaller() -> None:
    for alpha in np.linspace(0.1, 1.9, 19):
        slow = find_circle(1, 1, 1, 1, alpha).radius_pursuer_m
        fast = find_circle(1, 1, 1, 1, alpha, SATURATED).radius_pursuer_m
        assert fast < slow


def random_games(count: int) -> np.ndarray:
    rng = np.random.default_rng(3)
    ratios = np.exp(rng.uniform(-0.9, 0.9, (count, 4)))
    return np.column_stack([ratios, rng.uniform(0.05, 3.0, count)])


def test_closed_forms_are_the_first_root_of_the_balance() -> None:
    """The three branches of the solution agree with one plain search."""
    for vp, ve, kp, ke, alpha in random_games(200):
        for speeds, gains in [((vp, ve), (kp, kp)), ((vp, vp), (kp, ke))]:
            game = make_game(*speeds, *gains, alpha)
            circle = circle_of(game)
            high = min(gains[1] * alpha, gains[0] * pi)
            roots = sign_changes(partial(imbalance, game), 0, high)
            positive = [w for w in roots if w > 1e-9]
            assert circle.exists == bool(positive)
            if positive:
                assert circle.turning_rate_rad_s == pytest.approx(positive[0])


def test_every_circle_balances() -> None:
    """Closing speed is zero, the line of sight turns with the players."""
    found = 0
    for vp, ve, kp, ke, alpha in random_games(300):
        for law in TurningLaw:
            circle = find_circle(vp, ve, kp, ke, alpha, law)
            if not circle.exists:
                continue
            found += 1
            a, b = circle.pursuer_error_rad, circle.evader_error_rad
            u = alpha - b
            omega = circle.turning_rate_rad_s
            assert ve * cos(u) == pytest.approx(vp * cos(a), abs=1e-12)
            sight = (ve * sin(u) + vp * sin(a)) / circle.distance_m
            assert sight == pytest.approx(omega)
            assert omega == pytest.approx(kp * a)
            assert 0 <= b < alpha + 1e-12
            if law is TurningLaw.PROPORTIONAL:
                assert omega == pytest.approx(ke * b)
            else:
                assert omega <= ke * (1 + 1e-12)
                # Equal to rounding is the full rate, not sliding.
                assert circle.sliding == (omega < ke * (1 - 1e-12))
    assert found > 300


def test_faster_pursuer_still_circles() -> None:
    circle = find_circle(1.2, 1.0, 1.0, 1.0, pi / 2)
    assert circle.stable
    assert circle.turning_rate_rad_s == pytest.approx(np.arctan(1.2))


def test_much_slower_pursuer_never_circles() -> None:
    assert not find_circle(0.5, 1.0, 1.0, 1.0, 0.3).exists
    assert not find_circle(0.5, 1.0, 1.0, 1.0, 0.3, SATURATED).exists


@pytest.mark.parametrize("value", [0.0, -1.0, nan, inf])
@pytest.mark.parametrize("place", range(4))
def test_bad_values_are_refused(place: int, value: float) -> None:
    values = [1.0, 1.0, 1.0, 1.0]
    values[place] = value
    with pytest.raises(PlanError, match=f"must be finite and > 0 .*{value}"):
        find_circle(values[0], values[1], values[2], values[3])


def test_circle_of_values_equals_circle_of_the_game() -> None:
    values = (1.2, 1.0, 0.5, 0.9)
    named = {"angle": 2.4, "law": "saturated", "side_rule": "latched"}
    game = make_game(*values, **named)  # type: ignore[arg-type]
    found = find_circle(*values, **named)  # type: ignore[arg-type]
    assert found.exists
    assert found == circle_of(game)
    assert find_circle.__name__ == "find_circle"
    assert list(signature(find_circle).parameters) == list(
        signature(make_game).parameters
    )
