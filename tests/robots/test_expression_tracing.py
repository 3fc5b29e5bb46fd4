"""Test that traced formulas become functions that mean the same."""

from math import cos, sin
from typing import Any

import numpy as np
import pytest

from stepaside.robots.expression_tracing import (
    ExpressionTrace,
    Number,
    TracedNumber,
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


def test_constants_are_folded() -> None:
    x = ExpressionTrace().variable("x", 2.0)
    assert x * 0.0 == x - x == 0.0 * x == 0.0 / x == 0.0
    assert x / x == 1.0
    kept: list[Number] = [
        *(x * 1.0, 1.0 * x, x + 0.0, 0.0 + x, x - 0.0, x / 1.0),
        *(0.0 - (-x), -(0.0 - x), (-1.0 * x) * -1.0),
    ]
    assert all(number is x for number in kept)
    assert isinstance(x - 1.0, TracedNumber)


def test_common_subexpressions_are_computed_once() -> None:
    trace = ExpressionTrace()
    x, y = trace.variable("x"), trace.variable("y")
    assert x * y is y * x
    assert sine(x) is sine(x)
    assert x - y is not y - x
    shared = sine(x) * y
    text = trace.source("f", [shared + 1.0, shared * shared])
    assert text.count("sin(x)") == 1


def test_variables_are_reused_after_their_last_use() -> None:
    """Few names for a long chain; and the right number in each."""
    trace = ExpressionTrace()
    number: Number = trace.variable("x")
    for _ in range(40):
        number = sine(number) + number
    text = trace.source("chain", [number])
    names = {line.split(" = ")[0] for line in text.splitlines() if "=" in line}
    assert len(names) <= 2
    value = 0.4
    for _ in range(40):
        value = sin(value) + value
    (found,) = trace.formula("chain", [number]).function()(0.4)
    assert found == pytest.approx(value)


def test_functions_of_floats_are_their_own() -> None:
    assert sine(0.3) == sin(0.3) and cosine(0.3) == cos(0.3)
    assert hint_of(0.5) == 0.5
