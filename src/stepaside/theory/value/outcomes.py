"""Outcome of motions against answers, in compiled loops."""

from math import atan2, cos, exp, inf, pi, sin, sqrt, tau
from typing import Any, NamedTuple

from ...core.compilation import (
    compiled,
    compiled_parallel,
    inlined,
    parallel_range,
)

prange = parallel_range()


class OutcomeRules(NamedTuple):
    """How the outcome of a motion is read from the values after it.

    Flat, since Numba takes no nested tuples into parallel loops; the grid is
    that of :class:`.PoseGrid`. See also :func:`.solve_game`.
    """

    left: float  # x of the first node, in [m]
    right: float  # y of the first node, in [m]
    spacing: float  # of positions, in [m]
    columns: int  # nodes along x
    rows: int  # nodes along y
    headings: int
    outside: float  # value, in [m]; infinite: that of the edge plus the way
    sag: float = 0.0
    cubic: bool = False
    coarse: int = 1
    way: float = 0.0  # of a pursuer with a law in a part of a period, in [m]
    rate: float = 0.0  # gain of that law times that time; zero without a law
    tie: float = 0.0  # weight of the value after, where it decides nothing


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


@inlined
def bearing_of(x: float, y: float, heading: float) -> float:
    """Return the direction of a point from a heading, in [-pi, pi)."""
    bearing: float = (atan2(y, x) - heading + pi) % tau - pi
    return bearing


@inlined
def followed(
    pose: tuple[float, float, float],
    before: tuple[float, float],
    after: tuple[float, float],
    rules: OutcomeRules,
) -> tuple[float, float, float]:
    """Return the pose of a pursuer with a law after a part of a period.

    The direction of the robot, from its position before to that after,
    changes evenly meanwhile.
    """
    x, y, theta = pose
    closed = 1.0 - exp(-rules.rate)
    aim = bearing_of(before[0] - x, before[1] - y, theta)
    turn, nx, ny = aim * closed, x, y
    for _ in range(2):
        way = rules.way * (1.0 - turn * turn / 24.0)  # chord of the arc
        nx = x + way * cos(theta + 0.5 * turn)
        ny = y + way * sin(theta + 0.5 * turn)
        swing = bearing_of(after[0] - nx, after[1] - ny, theta + aim)
        turn = aim * closed + swing * (1.0 - closed / rules.rate)
    return nx, ny, theta + turn


@inlined
def outcome_of(
    v: Any,
    pose: tuple[float, float, float],
    motion: Any,
    answer: Any,
    rules: OutcomeRules,
) -> float:
    """Return the smaller of least distance on the way and value after it.

    The motion is given in the initial frame of the robot, the answer in
    that of the opponent. Shapes (parts, 3).
    """
    x, y, theta = pose
    c, s = cos(theta), sin(theta)
    px, py = x, y
    least = x * x + y * y
    other, parts = (0.0, 0.0, 0.0), len(motion)
    for n in range(parts):
        nx = x + c * motion[n, 0] - s * motion[n, 1]
        ny = y + s * motion[n, 0] + c * motion[n, 1]
        if rules.rate > 0.0:
            before = (px + other[0], py + other[1])
            other = followed(other, before, (nx, ny), rules)
        else:
            other = (answer[n, 0], answer[n, 1], answer[n, 2])
        nx, ny = nx - other[0], ny - other[1]
        dx, dy = nx - px, ny - py
        share = -(px * dx + py * dy) / (dx * dx + dy * dy + 1e-30)
        share = min(max(share, 0.0), 1.0)
        cx, cy = px + share * dx, py + share * dy
        least = min(least, cx * cx + cy * cy)
        px, py = nx, ny
    c, s = cos(other[2]), sin(other[2])
    after = look_up(
        v,
        c * px + s * py,
        c * py - s * px,
        theta + motion[parts - 1, 2] - other[2],
        rules,
    )
    found: float = min(after, sqrt(least) - rules.sag) + rules.tie * after
    return found


@inlined
def worst_answer(
    v: Any,
    pose: tuple[float, float, float],
    motion: Any,
    answers: Any,
    first: int,
    floor: float,
    rules: OutcomeRules,
) -> tuple[float, int]:
    """Return the worst outcome over the answers, and its number.

    The search ends where the outcome is at most ``floor``; the answer
    ``first`` is tried first.
    """
    worst, at = inf, first
    for m in range(-1, (len(answers) - 1) // rules.coarse + 1):
        number = first if m < 0 else m * rules.coarse
        found = outcome_of(v, pose, motion, answers[number], rules)
        if found < worst:
            worst, at = found, number
        if worst <= floor:
            return worst, at
    step = rules.coarse // 2
    while step > 0:
        middle = at
        for side in (-step, step):
            number = min(max(middle + side, 0), len(answers) - 1)
            found = outcome_of(v, pose, motion, answers[number], rules)
            if found < worst:
                worst, at = found, number
                if worst <= floor:
                    return worst, at
        step //= 2
    return worst, at


@inlined
def best_motion(
    v: Any,
    pose: tuple[float, float, float],
    motions: Any,
    answers: Any,
    guess: tuple[int, int],
    enough: float,
    rules: OutcomeRules,
) -> tuple[float, int, int]:
    """Return the best outcome over the motions, its number and answer's.

    The search ends where the outcome is at least ``enough``; the motion and
    the answer of ``guess`` are tried first.
    """
    best, chosen, worst, answer = -1.0, guess[0], guess[1], guess[1]
    for n in range(-1, len(motions)):
        number = guess[0] if n < 0 else n
        found, answer = worst_answer(
            v, pose, motions[number], answers, answer, best, rules
        )
        if found > best:
            best, chosen, worst = found, number, answer
        if best >= enough:
            break
    return best, chosen, worst


@compiled_parallel
def relax(
    v: Any,
    after: Any,
    guesses: Any,
    active: Any,
    motions: Any,
    answers: Any,
    rules: OutcomeRules,
    changes: Any,
) -> None:
    """Lower the values ``v`` of a period's begin to those ``after`` its end.

    Columns, of shape ``grid.shape[:2]``, are ``active`` if they can change;
    their greatest ``changes`` are written. The ``guesses``, best motion and
    worst answer of the last sweep, are replaced. Shape (*grid.shape, 2).
    """
    for i in prange(rules.columns):
        x = rules.left + rules.spacing * i
        for j in range(rules.rows):
            y = rules.right + rules.spacing * j
            changes[i, j] = 0.0
            for k in range(rules.headings if active[i, j] else 0):
                theta = tau / rules.headings * k
                if rules.headings == 1:
                    theta = atan2(y, x)
                guess = guesses[i, j, k, 0], guesses[i, j, k, 1]
                now = v[i, j, k]
                best, chosen, answer = best_motion(
                    after, (x, y, theta), motions, answers, guess, now, rules
                )
                guesses[i, j, k, 0], guesses[i, j, k, 1] = chosen, answer
                lower = max(best, 0.0)
                if lower < now:
                    changes[i, j] = max(changes[i, j], now - lower)
                    v[i, j, k] = lower


@compiled
def choose_all(
    v: Any,
    poses: Any,
    motions: Any,
    answers: Any,
    rules: OutcomeRules,
    out: Any,
) -> None:
    """Write the numbers of best motions and answers. Shape (n, 2)."""
    for n in range(len(poses)):
        x, y, theta = poses[n, 0], poses[n, 1], poses[n, 2]
        if rules.headings == 1:
            theta = atan2(y, x)
        _, out[n, 0], out[n, 1] = best_motion(
            v, (x, y, theta), motions, answers, (0, 0), inf, rules
        )


@compiled
def evaluate_motions(
    v: Any,
    poses: Any,
    motions: Any,
    answers: Any,
    rules: OutcomeRules,
    out: Any,
) -> None:
    """Lower ``out`` to the worst outcome of each motion from all poses."""
    for n in range(len(poses)):
        pose = (poses[n, 0], poses[n, 1], poses[n, 2])
        for k in range(len(motions)):
            found, _ = worst_answer(
                v, pose, motions[k], answers, 0, -1.0, rules
            )
            out[k] = min(out[k], found)
