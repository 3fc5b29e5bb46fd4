"""Grid of poses, and outcomes of motions on it, in compiled loops."""

from math import atan2, ceil, cos, exp, inf, pi, sin, sqrt, tau
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import (
    compiled,
    compiled_parallel,
    inlined,
    parallel_range,
)
from ...core.poses import Array

prange = parallel_range()


class PoseGrid(NamedTuple):
    """Grid over the poses of a robot in the frame of its opponent.

    On a grid of one heading the robot faces along the line of sight, away
    from its opponent. Also says how outcomes are read from values at its
    nodes; flat, since Numba takes no nested tuples into parallel loops.
    """

    left: float  # x of the first node, in [m]
    spacing: float  # of positions, in [m]
    columns: int  # nodes along x
    rows: int  # nodes along y
    headings: int
    # Y of the first node, in [m]; from 0 on the values of the other half are
    # those of the mirror image.
    right: float = 0.0
    # Value outside, in [m]; infinite: that of the edge plus the way there.
    outside: float = inf
    sag: float = 0.0  # deviation of the distance from that of chords, in [m]
    cubic: bool = False  # interpolates by cubics, with one heading only
    # Answers from one that is tried to the next, a power of two; the best is
    # then refined by halving.
    coarse: int = 1
    way: float = 0.0  # of a pursuer with a law in a part of a period, in [m]
    rate: float = 0.0  # gain of that law times that time; zero without a law
    tie: float = 0.0  # weight of the value after, where it decides nothing

    @classmethod
    def covering(
        cls,
        spacing: float,
        ahead: float,
        behind: float,
        aside: float,
        headings: int = 1,
    ) -> "PoseGrid":
        """Return the left half, with a node at the opponent.

        Edges lie at distances ahead of the opponent, behind and beside it, in
        [m].
        """
        back = ceil(behind / spacing)
        columns, rows = back + ceil(ahead / spacing) + 1, ceil(aside / spacing)
        return cls(-spacing * back, spacing, columns, rows + 1, headings)

    def whole(self) -> "PoseGrid":
        """Return the grid of both halves."""
        right = -self.spacing * (self.rows - 1)
        return self._replace(right=right, rows=2 * self.rows - 1)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nodes along x, y and the heading."""
        return self.columns, self.rows, self.headings

    def axes(self) -> tuple[Array, Array, Array]:
        """Return the coordinates of the nodes, in [m], [m] and [rad]."""
        i, j, k = (np.arange(n, dtype=np.float64) for n in self.shape)
        x: Array = self.left + self.spacing * i
        y: Array = self.right + self.spacing * j
        theta: Array = tau / self.headings * k
        return x, y, theta

    def distances(self, most: float = inf) -> Array:
        """Return the distances of the nodes, cut off. Shape ``shape``."""
        x, y, theta = self.axes()
        found: Array = np.minimum(np.hypot(x[:, None], y), most)
        return np.repeat(found[:, :, None], len(theta), axis=2)

    @property
    def edge(self) -> float:
        """Distance of the edge to the left of the opponent, in [m]."""
        return self.right + self.spacing * (self.rows - 1)

    @property
    def farthest(self) -> float:
        """Distance of the farthest node, in [m]."""
        return float(self.distances().max())


@inlined
def cubic_of(a: float, b: float, c: float, d: float, t: float) -> float:
    """Interpolate between b and c by the cubic of Catmull and Rom."""
    m, n, rise = 0.5 * (c - a), 0.5 * (d - b), c - b
    found: float = b + t * (
        m + t * (3.0 * rise - 2.0 * m - n + t * (m + n - 2.0 * rise))
    )
    return found


@inlined
def cubic_row(v: Any, i: int, j: int, s: float, grid: PoseGrid) -> float:
    """Interpolate by a cubic along x, in a row that may be mirrored."""
    if j < 0 and grid.right == 0.0:
        j = -j
    j = min(max(j, 0), grid.rows - 1)
    before, after = max(i - 1, 0), min(i + 2, grid.columns - 1)
    return cubic_of(
        v[before, j, 0], v[i, j, 0], v[i + 1, j, 0], v[after, j, 0], s
    )


@inlined
def cubic_cell(
    v: Any, i: int, j: int, s: float, t: float, grid: PoseGrid
) -> float:
    """Interpolate in a cell by cubics, within the range of its corners."""
    found = cubic_of(
        cubic_row(v, i, j - 1, s, grid),
        cubic_row(v, i, j, s, grid),
        cubic_row(v, i, j + 1, s, grid),
        cubic_row(v, i, j + 2, s, grid),
        t,
    )
    a, b, c, d = v[i, j, 0], v[i, j + 1, 0], v[i + 1, j, 0], v[i + 1, j + 1, 0]
    low, high = min(min(a, b), min(c, d)), max(max(a, b), max(c, d))
    kept: float = min(max(found, low), high)
    return kept


@inlined
def look_up(v: Any, x: float, y: float, theta: float, grid: PoseGrid) -> float:
    """Interpolate between the nodes of a cell, never beyond them."""
    if y < 0.0 and grid.right == 0.0:
        y, theta = -y, -theta
    u = (x - grid.left) / grid.spacing
    w = (y - grid.right) / grid.spacing
    columns, rows, count = grid.columns, grid.rows, grid.headings
    beyond = 0.0
    if not (0.0 <= u < columns - 1 and 0.0 <= w < rows - 1):
        if grid.outside != inf:
            return grid.outside
        ux, wx = min(max(u, 0.0), columns - 1.0), min(max(w, 0.0), rows - 1.0)
        beyond = grid.spacing * sqrt((u - ux) ** 2 + (w - wx) ** 2)
        u, w = ux, wx
    i, j = min(int(u), columns - 2), min(int(w), rows - 2)
    s, t = u - i, w - j
    if grid.cubic:
        return cubic_cell(v, i, j, s, t, grid) + beyond
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
def look_up_all(v: Any, poses: Any, grid: PoseGrid, out: Any) -> None:
    """Interpolate at many poses. Shape (n, 3)."""
    for n in range(len(poses)):
        x, y = poses[n, 0], poses[n, 1]
        found = look_up(v, x, y, poses[n, 2], grid)
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
    grid: PoseGrid,
) -> tuple[float, float, float]:
    """Return the pose of a pursuer with a law after a part of a period.

    The direction of the robot, from its position before to that after,
    changes evenly meanwhile.
    """
    x, y, theta = pose
    closed = 1.0 - exp(-grid.rate)
    aim = bearing_of(before[0] - x, before[1] - y, theta)
    turn, nx, ny = aim * closed, x, y
    for _ in range(2):
        way = grid.way * (1.0 - turn * turn / 24.0)  # chord of the arc
        nx = x + way * cos(theta + 0.5 * turn)
        ny = y + way * sin(theta + 0.5 * turn)
        swing = bearing_of(after[0] - nx, after[1] - ny, theta + aim)
        turn = aim * closed + swing * (1.0 - closed / grid.rate)
    return nx, ny, theta + turn


@inlined
def outcome_of(
    v: Any,
    pose: tuple[float, float, float],
    motion: Any,
    answer: Any,
    grid: PoseGrid,
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
        if grid.rate > 0.0:
            before = (px + other[0], py + other[1])
            other = followed(other, before, (nx, ny), grid)
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
        grid,
    )
    found: float = min(after, sqrt(least) - grid.sag) + grid.tie * after
    return found


@inlined
def worst_answer(
    v: Any,
    pose: tuple[float, float, float],
    motion: Any,
    answers: Any,
    first: int,
    floor: float,
    grid: PoseGrid,
) -> tuple[float, int]:
    """Return the worst outcome over the answers, and its number.

    The search ends where the outcome is at most ``floor``; the answer
    ``first`` is tried first.
    """
    worst, at = inf, first
    for m in range(-1, (len(answers) - 1) // grid.coarse + 1):
        number = first if m < 0 else m * grid.coarse
        found = outcome_of(v, pose, motion, answers[number], grid)
        if found < worst:
            worst, at = found, number
        if worst <= floor:
            return worst, at
    step = grid.coarse // 2
    while step > 0:
        middle = at
        for side in (-step, step):
            number = min(max(middle + side, 0), len(answers) - 1)
            found = outcome_of(v, pose, motion, answers[number], grid)
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
    grid: PoseGrid,
) -> tuple[float, int, int]:
    """Return the best outcome over the motions, its number and answer's.

    The search ends where the outcome is at least ``enough``; the motion and
    the answer of ``guess`` are tried first.
    """
    best, chosen, worst, answer = -1.0, guess[0], guess[1], guess[1]
    for n in range(-1, len(motions)):
        number = guess[0] if n < 0 else n
        found, answer = worst_answer(
            v, pose, motions[number], answers, answer, best, grid
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
    grid: PoseGrid,
    changes: Any,
) -> None:
    """Lower the values ``v`` of a period's begin to those ``after`` its end.

    Columns, of shape ``grid.shape[:2]``, are ``active`` if they can change;
    their greatest ``changes`` are written. The ``guesses``, best motion and
    worst answer of the last sweep, are replaced. Shape (*grid.shape, 2).
    """
    for i in prange(grid.columns):
        x = grid.left + grid.spacing * i
        for j in range(grid.rows):
            y = grid.right + grid.spacing * j
            changes[i, j] = 0.0
            for k in range(grid.headings if active[i, j] else 0):
                theta = tau / grid.headings * k
                if grid.headings == 1:
                    theta = atan2(y, x)
                guess = guesses[i, j, k, 0], guesses[i, j, k, 1]
                now = v[i, j, k]
                best, chosen, answer = best_motion(
                    after, (x, y, theta), motions, answers, guess, now, grid
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
    grid: PoseGrid,
    out: Any,
) -> None:
    """Write the numbers of best motions and answers. Shape (n, 2)."""
    for n in range(len(poses)):
        x, y, theta = poses[n, 0], poses[n, 1], poses[n, 2]
        if grid.headings == 1:
            theta = atan2(y, x)
        _, out[n, 0], out[n, 1] = best_motion(
            v, (x, y, theta), motions, answers, (0, 0), inf, grid
        )


@compiled
def evaluate_motions(
    v: Any,
    poses: Any,
    motions: Any,
    answers: Any,
    grid: PoseGrid,
    out: Any,
) -> None:
    """Lower ``out`` to the worst outcome of each motion from all poses."""
    for n in range(len(poses)):
        pose = (poses[n, 0], poses[n, 1], poses[n, 2])
        for k in range(len(motions)):
            found, _ = worst_answer(
                v, pose, motions[k], answers, 0, -1.0, grid
            )
            out[k] = min(out[k], found)
