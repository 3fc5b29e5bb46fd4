"""Test piecewise polynomials (paper, Sec. III-D)."""

import numpy as np

from stepaside.planning.com import PiecewisePolynomial, evaluate

DURATIONS = np.array([0.5, 0.2, 0.3])
DRAW = np.random.default_rng(2)
COEFFICIENTS = DRAW.normal(size=(4, 3, 2))
CURVE = PiecewisePolynomial(DURATIONS, COEFFICIENTS)


def test_powers_of_local_time_are_summed() -> None:
    s = np.array([0.1, 0.2, 0.3])
    expected = sum(c * s[:, None] ** j for j, c in enumerate(COEFFICIENTS))
    np.testing.assert_allclose(evaluate(COEFFICIENTS, s), expected)


def test_each_time_finds_its_piece() -> None:
    index, local = CURVE.locate([0.0, 0.49, 0.5, 0.6, 0.7, 0.99])
    np.testing.assert_array_equal(index, [0, 0, 1, 1, 2, 2])
    np.testing.assert_allclose(
        local, [0.0, 0.49, 0.0, 0.1, 0.0, 0.29], atol=1e-15
    )


def test_it_ends_where_its_last_piece_does() -> None:
    last = sum(c * 0.3**j for j, c in enumerate(COEFFICIENTS[:, 2]))
    np.testing.assert_allclose(CURVE.end, last)
