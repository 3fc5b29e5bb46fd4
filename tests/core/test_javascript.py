"""Functions of Python as JavaScript, run by Node.js."""

import inspect
import json
import shutil
import subprocess
from math import pi, tau
from typing import Any

import pytest

from stepaside.core.javascript import javascript_of
from stepaside.theory import laws

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(
    NODE is None, reason="there is no Node.js here"
)
LOOP = """\
def smooth(values, sums, gain):
    best, count = 0.0, 0
    for i in range(1, values.shape[0]):
        for j in range(values.shape[1]):
            sums[i, j] = sums[i - 1, j] + gain[j] * values[i, j]
            best = max(best, abs(sums[i, j]))
        if not best < 1.5:
            return i, best
        else:
            count += 1
    return -count, best
"""
TABLE = """const table = (shape, ...values) =>
  Object.assign(Float64Array.from(values), { shape });
"""


def run(source: str, expression: str) -> Any:
    """Evaluate an expression after JavaScript source."""
    text = f"{source}\nconsole.log(JSON.stringify({expression}));"
    done = subprocess.run(
        [str(NODE), "-e", text], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


@needs_node
def test_the_laws_decide_alike() -> None:
    names = (laws.wrap_once, laws.evasion_heading, laws.side_behind)
    source = "\n".join(
        inspect.getsource(law) for law in (*names, laws.update_side)
    )
    cases = [
        (side, bearing, hysteresis)
        for side in (-1, 0, 1)
        for bearing in (-3.1, -0.5, -0.1, 0.0, 0.1, 0.5, 3.1)
        for hysteresis in (0.0, 0.35)
    ]
    expected = []
    for side, bearing, hysteresis in cases:
        chosen = laws.update_side(side, bearing, hysteresis)
        heading = laws.evasion_heading(bearing, chosen, pi / 2)
        expected.append([chosen, heading])
    call = (
        f"{json.dumps(cases)}.map(([side, bearing, hysteresis]) => {{"
        "const chosen = update_side(side, bearing, hysteresis);"
        "return [chosen, evasion_heading(bearing, chosen, Math.PI / 2)]; })"
    )
    assert run(javascript_of(source, {"pi": pi, "tau": tau}), call) == expected


@needs_node
@pytest.mark.parametrize(("scale", "expected"), [(1.0, -2), (2.0, 2)])
def test_a_loop_over_rows_ends_where_python_ends(
    scale: float, expected: int
) -> None:
    values = [0.0, 0.0, 0.5 * scale, -0.25, 0.5 * scale, 0.75]
    call = (
        f"(() => {{ const sums = table([3, 2], 0, 0, 0, 0, 0, 0);"
        f"const found = smooth(table([3, 2], {str(values)[1:-1]}), sums,"
        "table([2], 1, 0.5)); return [found, Array.from(sums)]; })()"
    )
    (row, best), sums = run(TABLE + javascript_of(LOOP), call)
    assert (row, best) == (expected, scale)
    assert sums[2:] == [0.5 * scale, -0.125, scale, 0.25]


@pytest.mark.parametrize(
    "line", ["while x: pass", "x.y = 1", "x = [1]", "x = 2 ** x", "x = f(*x)"]
)
def test_a_construct_beyond_the_subset_is_refused(line: str) -> None:
    with pytest.raises(NotImplementedError, match="line"):
        javascript_of(f"def f(x):\n    {line}")
