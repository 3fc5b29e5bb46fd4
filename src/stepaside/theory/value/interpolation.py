"""Interpolation of the values of a grid, in compiled loops."""

from math import inf, sqrt, tau
from typing import Any, NamedTuple

from ...core.compilation import compiled, inlined


class OutcomeRules(NamedTuple):
    """How the outcome of a motion is read from the values after it.

    Numba takes no nested tuples into parallel loops.

    Attributes:
        left: x of the first node, in [m].
        right: y of the first node, in [m].
        spacing: Spacing of positions, in [m].
        columns: Nodes along x.
        rows: Nodes along y.
        headings: Nodes along the heading.
        outside: Value outside the grid, in [m]; if infinite, that of the
            edge plus the distance from it.
        sag: Deviation of the distance from that of chords, in [m].
        cubic: Whether values on a grid of one heading are interpolated by
            cubics, within the range of the corners of a cell.
        coarse: Answers from one that is tried to the next; the best is then
            refined by halving. A power of two.
        way: Way of a pursuer with a law in a part of a period, in [m].
        rate: Gain of that law times that time, in [1]; zero without a law.
        tie: Weight of the value after a period where it decides nothing.
    """

    left: float
    right: float
    spacing: float
    columns: int
    rows: int
    headings: int
    outside: float
    sag: float = 0.0
    cubic: bool = False
    coarse: int = 1
    way: float = 0.0
    rate: float = 0.0
    tie: float = 0.0


@inlined
def cubic_of(a: float, b: float, c: float, d: float, t: float) -> float:
    """Interpolate between b and c by the cubic of Catmull and Rom."""
    m, n, rise = 0.5 * (c - a), 0.5 * (d - b), c - b
    found: float = b + t * (
        m + t * (3.0 * rise - 2.0 * m - n + t * (m + n - 2.0 * rise))
    )
    return found


@inlined
def cubic_row(v: Any, i: int, j: int, s: float, rules: OutcomeRules) -> float:
    """Interpolate by a cubic along x, in a row that may be mirrored."""
    if j < 0 and rules.right == 0.0:
        j = -j
    j = min(max(j, 0), rules.rows - 1)
    before, after = max(i - 1, 0), min(i + 2, rules.columns - 1)
    return cubic_of(
        v[before, j, 0], v[i, j, 0], v[i + 1, j, 0], v[after, j, 0], s
    )


@inlined
def cubic_cell(
    v: Any, i: int, j: int, s: float, t: float, rules: OutcomeRules
) -> float:
    """Interpolate in a cell by cubics, within the range of its corners."""
    found = cubic_of(
        cubic_row(v, i, j - 1, s, rules),
        cubic_row(v, i, j, s, rules),
        cubic_row(v, i, j + 1, s, rules),
        cubic_row(v, i, j + 2, s, rules),
        t,
    )
    a, b, c, d = v[i, j, 0], v[i, j + 1, 0], v[i + 1, j, 0], v[i + 1, j + 1, 0]
    low, high = min(min(a, b), min(c, d)), max(max(a, b), max(c, d))
    kept: float = min(max(found, low), high)
    return kept


@inlined
def look_up(
    v: Any, x: float, y: float, theta: float, rules: OutcomeRules
) -> float:
    """Interpolate between the nodes of a cell, never beyond them."""
    if y < 0.0 and rules.right == 0.0:
        y, theta = -y, -theta
    u = (x - rules.left) / rules.spacing
    w = (y - rules.right) / rules.spacing
    columns, rows, count = rules.columns, rules.rows, rules.headings
    beyond = 0.0
    if not (0.0 <= u < columns - 1 and 0.0 <= w < rows - 1):
        if rules.outside != inf:
            return rules.outside
        ux, wx = min(max(u, 0.0), columns - 1.0), min(max(w, 0.0), rows - 1.0)
        beyond = rules.spacing * sqrt((u - ux) ** 2 + (w - wx) ** 2)
        u, w = ux, wx
    i, j = min(int(u), columns - 2), min(int(w), rows - 2)
    s, t = u - i, w - j
    if rules.cubic:
        return cubic_cell(v, i, j, s, t, rules) + beyond
    a = (theta / tau * count) % count
    k, r = int(a) % count, a - int(a)
    n = (k + 1) % count
    p, q = 1.0 - s, 1.0 - t
    low = p * (q * v[i, j, k] + t * v[i, j + 1, k]) + s * (
        q * v[i + 1, j, k] + t * v[i + 1, j + 1, k]
    )
    high = p * (q * v[i, j, n] + t * v[i, j + 1, n]) + s * (
        q * v[i + 1, j, n] + t * v[i + 1, j + 1, n]
    )
    linear: float = (1.0 - r) * low + r * high
    return linear + beyond


@compiled
def look_up_all(v: Any, poses: Any, rules: OutcomeRules, out: Any) -> None:
    """Interpolate at many poses. Shape (n, 3)."""
    for n in range(len(poses)):
        x, y = poses[n, 0], poses[n, 1]
        found = look_up(v, x, y, poses[n, 2], rules)
        out[n] = min(found, sqrt(x * x + y * y))
