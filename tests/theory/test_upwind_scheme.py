"""Test the formulas of one cell, and the two backends."""

from typing import Any

import numpy as np
import pytest

from stepaside.core.compilation import load_numba
from stepaside.theory.bound import DiscretisationScheme, Grid, two_car_game
from stepaside.theory.bound.compiled_stage import (
    RowStates,
    mark_active_rows,
    stage_blocks,
)
from stepaside.theory.bound.state_grid import fill_ghosts
from stepaside.theory.bound.upwind_scheme import (
    lax_friedrichs,
    maximum,
    minimum,
    upwind,
    upwind_product,
    weno5,
)
from stepaside.theory.bound.value_solver import (
    make_stage_parameters,
    stage_arrays,
)

EPS = 12e-6


def slopes_of(values: Any, eps: float) -> tuple[Any, Any]:
    """Slopes of seven values, times the spacing."""
    a, b, c, d, e, f, g = values
    return weno5(a, b, c, d, e, f, g, eps)


def plain(function: Any) -> Any:
    """The function that was compiled."""
    return getattr(function, "py_func", function)


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


def test_both_fluxes_agree_with_the_hamiltonian_where_smooth() -> None:
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
        for flux in (upwind, lax_friedrichs):
            found = flux(closing, swing, law, reach_p, reach_e, slopes)
            assert found == pytest.approx(true, rel=1e-6, abs=1e-6)


def test_godunov_is_monotone_and_less_dissipative_than_lax() -> None:
    """More to either side never lowers the new value."""
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
        valley = np.sort(np.reshape(slopes, (3, 2)), axis=1).ravel()
        here = upwind(closing, swing, law, p, e, tuple(valley))
        broad = lax_friedrichs(closing, swing, law, p, e, tuple(valley))
        assert broad >= here - 1e-6


@pytest.mark.parametrize("scheme", DiscretisationScheme)
@pytest.mark.skipif(load_numba() is None, reason="needs Numba")
def test_numpy_stage_equals_the_compiled_stage(
    scheme: DiscretisationScheme, monkeypatch: pytest.MonkeyPatch
) -> None:
    from stepaside.theory.bound import (
        upwind_scheme as numerics,
    )
    from stepaside.theory.bound import (
        value_solver as arrays,
    )

    for name in ("upwind_product", "maximum", "minimum"):
        monkeypatch.setattr(numerics, name, plain(getattr(numerics, name)))
    for name in ("weno5", "upwind", "lax_friedrichs"):
        monkeypatch.setattr(arrays, name, plain(getattr(numerics, name)))
    grid = Grid(0.4, 3.4, 10, 12, 10)
    setting, rate = make_stage_parameters(
        two_car_game(1.0, 1.2, 0.9, 1.1), grid, scheme, np.float64
    )
    rng = np.random.default_rng(4)
    first: Any = rng.uniform(0.4, 3.0, tuple(n + 6 for n in grid.shape))
    fill_ghosts(first)
    active = rng.random(grid.shape[:2]) > 0.2
    outs, moves = [], []
    for stage in (stage_blocks, stage_arrays):
        out, moved = np.zeros_like(first), np.ones(grid.shape[:2], bool)
        rows = RowStates(active, moved, 1e-9)
        stage(first, first + 0.01, out, 0.75, 0.7 / rate, True, setting, rows)
        outs.append(out[3:-3, 3:-3, 3:-3])
        moves.append(moved)
    np.testing.assert_allclose(outs[0], outs[1], rtol=1e-9)
    np.testing.assert_array_equal(moves[0], moves[1])
    inactive = first[3:-3, 3:-3, 3:-3][~active]
    np.testing.assert_array_equal(outs[0][~active], inactive)


def test_active_rows_extend_by_one_stencil_per_stage() -> None:
    moved, active = np.zeros((8, 20), bool), np.ones((8, 20), bool)
    assert not mark_active_rows(moved, active, 3, 3) and not active.any()
    moved[1, 10] = True
    assert mark_active_rows(moved, active, 3, 1)
    assert set(np.flatnonzero(active[:, 10])) == {0, 1, 2, 3, 4}
    assert set(np.flatnonzero(active[1])) == {7, 8, 9, 10, 11, 12, 13}
    assert active.sum() == 5 + 6
    assert mark_active_rows(moved, active, 3, 3)
    assert active[1].sum() == 19 and active[:, 10].all()
