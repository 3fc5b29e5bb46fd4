"""Test that compiled loops compute what Python computes, to the bit."""

from fractions import Fraction
from math import atan2, cos, sin, tan
from typing import Any

import numpy as np
import pytest

from stepaside.core.llvm_assembly import translate
from stepaside.core.machine_code import Kernel

pytest.importorskip("llvmlite")

FORMULA = """
def turned(x, y, angle):
    c = cos(angle)
    s = sin(angle)
    c, length = c, 0.0
    return (((c * x) - (s * y)), ((s * x) + (c * y)), (-x) / 3.0)
"""
LOOP = """
def fold(points, angles, order, scale, results):
    \"\"\"Sum turned points.\"\"\"
    total, n = 0.0, points.shape[0]
    for i in range(n):
        k = order[i]
        where = turned(points[k, 0], points[k, 1], angles[k])
        if where[0] > 0.5 and not (k == 2 or k >= 7):
            results[i] = where[0] * scale
        elif -1.0 <= where[1] < 0.0:
            results[i] -= abs(where[1]) / scale
        else:
            results[i] = max(where[0], where[1], where[2], 0.25) - k
        for j in range(1, order[i]):
            results[i] += min(where[2], 0.1 * j) if j != 3 else 1.0
        total += results[i]
        if total > 1e3:
            return -i
    results[0] = total
    return n * 2 - 1
"""


def in_python(source: str, name: str) -> Any:
    namespace: dict[str, Any] = {"sin": sin, "cos": cos}
    exec(source, namespace)
    return namespace[name]


@pytest.mark.parametrize("seed", range(20))
def test_a_loop_has_the_bits_of_python(seed: int) -> None:
    source = FORMULA.replace("    c, length = c, 0.0\n", "") + LOOP
    generator = np.random.default_rng(seed)
    points, angles = generator.normal(size=(9, 2)), generator.normal(size=9)
    order = generator.permutation(9)
    scale = [0.7, 1e3][seed % 2]
    start = generator.normal(size=9)
    found = []
    for fold in (in_python(source, "fold"), Kernel("fold", source, "21i01")):
        results = start.copy()
        returned = fold(points, angles, order, scale, results)
        found.append((returned, results))
    assert found[0][0] == found[1][0]
    np.testing.assert_array_equal(found[0][1], found[1][1])


def test_a_division_by_zero_is_infinite() -> None:
    source = "def divide(x):\n    x[0] = 1.0 / x[0]\n"
    values = np.zeros(1)
    assert Kernel("divide", source, "1")(values) == 0
    assert np.isinf(values[0])


@pytest.mark.parametrize(
    ("source", "arguments"),
    [
        (FORMULA + "def loop(x):\n    return 0\n", "1"),  # two targets
        ("def loop(x):\n    while x[0] > 0.0:\n        x[0] -= 1.0\n", "1"),
        ("def loop(x):\n    x[0] = exp(x[0])\n", "1"),
        ("def loop(x):\n    return x[0]\n", "1"),  # a float
        ("def loop(x):\n    x[0, 0] = 1.0\n", "1"),
        ("def loop(x):\n    x[0] = 1\n", "1"),
        ("def loop(x):\n    x[0.0] = 1.0\n", "1"),
        ("def loop(x):\n    a = 1\n    a = x[0]\n", "1"),
        ("def loop(x):\n    x[0] = x[0] ** 2.0\n", "1"),
    ],
)
def test_what_is_beyond_the_subset_is_refused(
    source: str, arguments: str
) -> None:
    with pytest.raises(NotImplementedError):
        translate(source, arguments)


def test_tangents_and_fused_products_have_the_bits_of_python() -> None:
    source = (
        "def fold(x):\n    for i in range(x.shape[0]):\n"
        "        fused = fma(x[i, 0], x[i, 1], x[i, 2])\n"
        "        x[i, 0] = tan(x[i, 0])\n"
        "        x[i, 1] = atan2(x[i, 1], x[i, 2])\n"
        "        x[i, 2] = fused"
    )
    rows = np.random.default_rng(1).normal(size=(50, 3))
    rows[0] = 1.0 + 2.0**-30, 1.0 - 2.0**-30, -1.0  # 0 if rounded twice
    folded = rows.copy()
    Kernel("fold", source, "2")(folded)
    for (a, b, c), found in zip(rows.tolist(), folded.tolist(), strict=True):
        fused = float(Fraction(a) * Fraction(b) + Fraction(c))
        assert found == [tan(a), atan2(b, c), fused]
