"""Test that traced formulas become functions that mean the same."""

from typing import Any

import numpy as np

from stepaside.robots.expression_tracing import (
    ExpressionTrace,
    Number,
    cosine,
    hint_of,
    sine,
)


def formula(x: Number, y: Number) -> list[Number]:
    """Every operation, on either side, with constants and without."""
    shared = x * y - 2.0
    return [
        (1.5 + x) * (y + 2.5) - (3.0 - x),
        shared / (y + 4.0) + shared,
        -(x - y) * (-x) + (-y) / 3.0,
        sine(x + 0.5) * cosine(y) - 1.0 / (x + 3.0),
        (x + 1.0) + 2.0 - y - (-x),
        (-x) / (-y - 5.0) + 1.0 / (-x - 6.0) + (2.0 + (-x)),
        -x - y,
        0.25,
    ]


def test_a_traced_function_equals_its_formula() -> None:
    trace = ExpressionTrace()
    x, y = trace.variable("x", 0.3), trace.variable("y", 0.7)
    traced = formula(x, y)
    function = trace.formula("formula", traced).function()
    np.testing.assert_allclose(
        [hint_of(number) for number in traced], function(0.3, 0.7)
    )
    for a, b in np.random.default_rng(1).uniform(-2, 2, (20, 2)).tolist():
        expected: list[Any] = formula(a, b)
        np.testing.assert_allclose(function(a, b), expected, rtol=1e-13)
