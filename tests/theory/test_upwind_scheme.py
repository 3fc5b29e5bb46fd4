"""Test the formulas of one cell."""

from typing import Any

import numpy as np
import pytest

from stepaside.theory.bound.upwind_scheme import (
    maximum,
    minimum,
    upwind,
    upwind_product,
    weno5,
)

EPS = 12e-6


def slopes_of(values: Any, eps: float) -> tuple[Any, Any]:
    """Slopes of seven values, times the spacing."""
    a, b, c, d, e, f, g = values
    return weno5(a, b, c, d, e, f, g, eps)


def test_slopes_of_a_parabola_are_exact() -> None:
    x = np.arange(-3.0, 4.0)
    left, right = slopes_of(2.0 + 3.0 * x + 0.5 * x * x, EPS)
    assert left == pytest.approx(3.0) and right == pytest.approx(3.0)


def test_slopes_are_of_fifth_order_where_smooth() -> None:
    errors = []
    for step in (0.2, 0.1):
        points = np.exp(step * np.arange(-3, 4))
        left, right = slopes_of(points, EPS * step**2)
        errors.append([abs(slope / step - 1.0) for slope in (left, right)])
    ratio = np.array(errors[0]) / np.array(errors[1])
    assert (ratio > 20.0).all(), ratio


def test_kink_is_not_smoothed() -> None:
    """Each side takes its slope from its own side of the kink."""
    values = np.abs(np.arange(-3.0, 4.0) - 0.5)
    left, right = slopes_of(values, 1e-9)
    assert left == pytest.approx(-1.0, abs=1e-3)
    values = np.abs(np.arange(-3.0, 4.0) + 0.5)
    left, right = slopes_of(values, 1e-9)
    assert right == pytest.approx(1.0, abs=1e-3)


def test_mirrored_values_have_mirrored_slopes() -> None:
    values = np.random.default_rng(0).normal(size=7)
    left, right = slopes_of(values, EPS)
    back, forth = slopes_of(values[::-1], EPS)
    assert back == pytest.approx(-right) and forth == pytest.approx(-left)


def test_flux_takes_the_upwind_slope() -> None:
    assert upwind_product(2.0, 10.0, 1.0) == pytest.approx(2.0)
    assert upwind_product(-2.0, 10.0, 1.0) == pytest.approx(-20.0)
    assert maximum(2.0, -3.0) == 2.0 and minimum(2.0, -3.0) == -3.0


def test_flux_agrees_with_the_hamiltonian_where_smooth() -> None:
    """The least over the pursuer of the most over the evader, by search."""
    rng = np.random.default_rng(1)
    turns = np.linspace(-1.0, 1.0, 201)
    for _ in range(50):
        closing, swing, law, pr, pa, pp = rng.normal(size=6)
        reach_p, reach_e = rng.uniform(0.1, 2.0, 2)
        true = closing * pr
        true += ((swing - law - reach_p * turns) * pa).min()
        true += ((swing - reach_e * turns) * pp).max()
        slopes = (pr, pr, pa, pa, pp, pp)
        found = upwind(closing, swing, law, reach_p, reach_e, slopes)
        assert found == pytest.approx(true, rel=1e-6, abs=1e-6)


def test_more_to_either_side_never_lowers_the_new_value() -> None:
    rng = np.random.default_rng(2)
    for _ in range(200):
        closing, swing, law = rng.normal(size=3)
        slopes = list(rng.normal(size=6))
        p, e = rng.uniform(0.1, 2.0, 2)
        here = upwind(closing, swing, law, p, e, tuple(slopes))
        for n in range(6):
            more = slopes.copy()
            more[n] += 0.3 if n % 2 else -0.3
            then = upwind(closing, swing, law, p, e, tuple(more))
            assert then >= here - 1e-9
