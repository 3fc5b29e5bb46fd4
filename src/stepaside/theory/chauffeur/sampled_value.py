r"""Value of the chauffeur's game with a held velocity, by exact steps.

At each decision the evader commits to a velocity and holds it for a period;
the pursuer answers with the turning rate that is worst for it, held for the
same time. With :math:`T` the motion over one period,

.. math::
    V(x) = \max_w \min_u \min\bigl(d(x, w, u), V(T(x, w, u))\bigr)

where :math:`d` is the least distance on the way. The best paths are straight
lines against full turns, so a period of many cells costs little, and values
are interpolated rarely: that keeps the barrier sharp, where schemes that
advance less than a cell at a time smooth it out.

Lengths are in turning radii, speeds in those of the pursuer. Only y >= 0 is
computed. Outside the grid the value is that of a pursuer that comes back
from afar: the one straight ahead, at the far edge.
"""

from collections.abc import Callable
from dataclasses import replace
from math import ceil, cos, sin, sqrt, tau
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import compiled, inlined
from ...core.errors import check_within
from .chauffeur_game import Array, ChauffeurGame, guaranteed_distance
from .chauffeur_table import ChauffeurTable, HalfPlane

DIRECTIONS = 48  # of the evader's velocity; 96 change c* by 0.03 %
TURNS = 9  # of the pursuer, before the best is refined by halving
HALVINGS = 4
PARTS = 3  # chords on which the distance within a period is measured
PERIOD = 0.31  # over the speed ratio: 0.2 R/V at 0.643
MOST = 400  # periods
AHEAD, BEHIND, ASIDE = 1.7, 0.8, 1.4  # edges, over the speed ratio
STILL = 1e-5  # change over a period that counts as none, in radii


class MotionTables(NamedTuple):
    """Constants of a relaxation, for compiled loops.

    Attributes:
        velocities: Velocities of the evader away from the pursuer and to the
            left of the line of sight. Shape (n, 2).
        turns: Turning rates of the pursuer. Shape (m,).
        period: Time for which both are held.
        left: x of the first node.
        spacing: Spacing of the nodes.
        edge: Nodes along x and y, without padding. Shape (2,).
    """

    velocities: Any
    turns: Any
    period: float
    left: float
    spacing: float
    edge: Any


@inlined
def cubic(a: float, b: float, c: float, d: float, t: float) -> float:
    """Interpolate between b and c by the cubic of Catmull and Rom."""
    m, n, rise = 0.5 * (c - a), 0.5 * (d - b), c - b
    slope: float = b + t * (
        m + t * (3.0 * rise - 2.0 * m - n + t * (m + n - 2.0 * rise))
    )
    return slope


@inlined
def interpolate(
    v: Any, x: float, y: float, tables: MotionTables, outside: float
) -> float:
    """Interpolate between the values of a cell, never beyond them.

    Args:
        v: Values with one more node on every side.
        x: Position ahead of the pursuer.
        y: Position aside of it.
        tables: Grid.
        outside: Value outside the grid.
    """
    u = (x - tables.left) / tables.spacing + 1.0
    w = abs(y) / tables.spacing + 1.0
    if u < 1.0 or u > tables.edge[0] or w > tables.edge[1]:
        return outside
    i = min(int(u), tables.edge[0] - 1)
    j = min(int(w), tables.edge[1] - 1)
    s, t = u - i, w - j
    e, f = v[i - 1], v[i]
    g, h = v[i + 1], v[i + 2]
    found = cubic(
        cubic(e[j - 1], f[j - 1], g[j - 1], h[j - 1], s),
        cubic(e[j], f[j], g[j], h[j], s),
        cubic(e[j + 1], f[j + 1], g[j + 1], h[j + 1], s),
        cubic(e[j + 2], f[j + 2], g[j + 2], h[j + 2], s),
        t,
    )
    a, b, c, d = f[j], f[j + 1], g[j], g[j + 1]
    low, high = min(min(a, b), min(c, d)), max(max(a, b), max(c, d))
    kept: float = min(max(found, low), high)
    return kept


@inlined
def outcome(
    v: Any,
    state: tuple[float, float, float, float],
    u: float,
    tables: MotionTables,
    outside: float,
) -> float:
    """Return the value of one period with held controls.

    Args:
        v: Values at the end of the period.
        state: Position of the evader and its velocity, in the frame of the
            pursuer at the begin.
        u: Turning rate of the pursuer.
        tables: Grid and period.
        outside: Value outside the grid.
    """
    x, y, vx, vy = state
    least = x * x + y * y
    px, py = x, y
    for k in range(PARTS):
        t = tables.period * (k + 1) / PARTS
        z = u * t
        q = z * z
        # sin(z) / z and (1 - cos(z)) / z
        along = 1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0))
        across = 0.5 * z * (1.0 - q / 12.0 * (1.0 - q / 30.0))
        nx, ny = x + vx * t - t * along, y + vy * t - t * across
        dx, dy = nx - px, ny - py
        share = -(px * dx + py * dy) / (dx * dx + dy * dy + 1e-30)
        share = min(max(share, 0.0), 1.0)
        cx, cy = px + share * dx, py + share * dy
        least = min(least, cx * cx + cy * cy)
        px, py = nx, ny
    c, s = cos(u * tables.period), sin(u * tables.period)
    later = interpolate(v, c * px + s * py, c * py - s * px, tables, outside)
    return min(later, sqrt(least))


@inlined
def worst_outcome(
    v: Any,
    state: tuple[float, float, float, float],
    floor: float,
    guess: float,
    tables: MotionTables,
    outside: float,
) -> tuple[float, float]:
    """Return the least value over the pursuer's turns, and its turn.

    Args:
        v: As in :func:`outcome`.
        state: As in :func:`outcome`.
        floor: The search ends where the value is at most this.
        guess: Turn that is tried first.
        tables: As in :func:`outcome`.
        outside: As in :func:`outcome`.
    """
    worst, at = outcome(v, state, guess, tables, outside), guess
    for k in range(len(tables.turns)):
        if worst <= floor:
            return worst, at
        found = outcome(v, state, tables.turns[k], tables, outside)
        if found < worst:
            worst, at = found, tables.turns[k]
    step = 1.0 / (len(tables.turns) - 1)
    for _ in range(HALVINGS):
        middle = at
        for side in (-1.0, 1.0):
            u = min(max(middle + side * step, -1.0), 1.0)
            found = outcome(v, state, u, tables, outside)
            if found < worst:
                worst, at = found, u
                if worst <= floor:
                    return worst, at
        step *= 0.5
    return worst, at


@inlined
def best_choice(
    v: Any,
    x: float,
    y: float,
    guess: tuple[float, float],
    tables: MotionTables,
    outside: float,
) -> tuple[float, float, float]:
    """Return value, number of the best velocity, and the answer to it.

    Args:
        v: Values at the end of the period.
        x: Position of the evader ahead of the pursuer.
        y: Position to its left.
        guess: Number of the velocity and turn that are tried first.
        tables: Velocities, turns, period and grid.
        outside: Value outside the grid.
    """
    r = sqrt(x * x + y * y) + 1e-12
    c, s = x / r, y / r
    best, chosen, answer = -1.0, guess[0], guess[1]
    for n in range(-1, len(tables.velocities)):
        k = int(guess[0]) if n < 0 else n
        away, left = tables.velocities[k, 0], tables.velocities[k, 1]
        state = (x, y, away * c - left * s, away * s + left * c)
        found, u = worst_outcome(v, state, best, answer, tables, outside)
        if found > best:
            best, chosen, answer = found, 1.0 * k, u
    return best, chosen, answer


@compiled
def relax(
    v: Any, out: Any, guesses: Any, tables: MotionTables, outside: float
) -> None:
    """Compute the values one period earlier.

    Args:
        v: Values, with one more node on every side.
        out: Output: values of the nodes, likewise; may be ``v``.
        guesses: Best velocity and answer of each node in the last call;
            replaced. Shape (nodes along x, nodes along y, 2).
        tables: Velocities, turns, period and grid.
        outside: Value outside the grid.
    """
    for i in range(1, tables.edge[0] + 1):
        x = tables.left + (i - 1) * tables.spacing
        for j in range(1, tables.edge[1] + 1):
            y = (j - 1) * tables.spacing
            last = guesses[i - 1, j - 1, 0], guesses[i - 1, j - 1, 1]
            best, k, u = best_choice(v, x, y, last, tables, outside)
            guesses[i - 1, j - 1, 0] = k
            guesses[i - 1, j - 1, 1] = u
            out[i, j] = min(best, v[i, j])


@compiled
def choose(
    v: Any, points: Any, out: Any, tables: MotionTables, outside: float
) -> None:
    """Compute the decisions of both players at some positions.

    Args:
        v: Values, with one more node on every side.
        points: Positions x, y of the evader. Shape (n, 2).
        out: Output: velocity (x, y) of the evader and turning rate of the
            pursuer. Shape (n, 3).
        tables: Velocities, turns, period and grid.
        outside: Value outside the grid.
    """
    for n in range(len(points)):
        x, y = points[n, 0], points[n, 1]
        guess = (0.0, 0.0)
        _, k, u = best_choice(v, x, y, guess, tables, outside)
        r = sqrt(x * x + y * y) + 1e-12
        away, left = tables.velocities[int(k)]
        out[n, 0] = (away * x - left * y) / r
        out[n, 1] = (away * y + left * x) / r
        out[n, 2] = u


def solve_chauffeur(
    game: ChauffeurGame,
    cells: int = 40,
    *,
    period: float | None = None,
    farthest: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> ChauffeurTable:
    """Compute the value: the guaranteed distance from every relative state.

    Args:
        game: Speeds and turning radius.
        cells: Number of cells over the largest speed of the evader times the
            radius over the pursuer's speed.
        period: Time between two decisions of the evader, in [s]; by default
            a small part of a turn, which stands for continuous decisions.
        farthest: Largest distance ahead in the table, in [m].
        progress: Called with the fraction of the work done since the last
            call; the rest follows at the end.

    Returns:
        Table of the value.

    Raises:
        PlanError: If a value is out of range.
    """
    begin = perf_counter()
    check_within(cells, 8, 400, "cells", "1")
    speed, radius, ratio = (
        game.pursuer_speed,
        game.turning_radius,
        game.ratio,
    )
    held = PERIOD * ratio if period is None else period * speed / radius
    check_within(held * radius / speed, 1e-3, radius / speed, "period", "s")
    limit = guaranteed_distance(min(ratio, 1.0))
    far = AHEAD * ratio + limit + held
    if farthest is not None:
        far = max(far, farthest / radius)
    plane = HalfPlane.covering(
        ratio / cells,
        far,
        BEHIND * ratio + limit + held,
        ASIDE * ratio + limit + held,
    )
    tables = motion_tables(game, plane, held)
    v, done = _converge(plane, tables, 2.0 * limit, progress)
    if progress is not None:
        progress(1.0 - done)
    return ChauffeurTable(
        game,
        plane,
        v[1:-1, 1:-1].copy(),
        period=held * radius / speed,
        seconds=perf_counter() - begin,
    )


def motion_tables(
    game: ChauffeurGame, plane: HalfPlane, period: float
) -> MotionTables:
    """Return the constants of compiled loops, in radii and pursuer speeds."""
    return MotionTables(
        game.velocities.boundary(DIRECTIONS) / game.pursuer_speed,
        np.linspace(-1.0, 1.0, TURNS),
        period,
        -plane.behind,
        plane.spacing,
        np.array(plane.shape),
    )


def padded(plane: HalfPlane, values: Array) -> Array:
    """Return values with one more node on every side: mirrored, or kept."""
    v = np.pad(values, 1, mode="edge")
    v[:, 0] = v[:, 2]
    return v


def _converge(
    plane: HalfPlane,
    tables: MotionTables,
    most: float,
    progress: Callable[[float], object] | None,
) -> tuple[Array, float]:
    """Relax until nothing changes; values above ``most`` are cut off.

    Values only fall, so each sweep may use those it has just lowered.
    """
    x, y = plane.axes()
    v = padded(plane, np.minimum(np.hypot(x[:, None], y), most))
    guesses, done = np.zeros((*plane.shape, 2)), 0.0
    for n in range(MOST):
        before = v[1:-1, 1:-1].copy()
        relax(v, v, guesses, tables, float(v[-2, 1]))
        change = float((before - v[1:-1, 1:-1]).max())
        v = padded(plane, v[1:-1, 1:-1])
        if progress is not None:
            progress((n + 1) / MOST - done)
            done = (n + 1) / MOST
        if change < STILL * most:
            break
    return v, done


def decide(table: ChauffeurTable, x: Array, y: Array) -> tuple[Array, Array]:
    """Return the decisions of both players from a table.

    Args:
        table: Table of the game.
        x: Positions of the evader ahead of the pursuer, in [m]. Shape (n,).
        y: Positions to its left, in [m]. Shape (n,).

    Returns:
        Velocities of the evader in the frame of the pursuer, in [m/s], shape
        (n, 2), to be held for the period of the table; and turning rates of
        the pursuer in answer, in [rad/s], shape (n,).
    """
    game = table.game
    radius, speed = game.turning_radius, game.pursuer_speed
    tables = motion_tables(game, table.plane, table.period * speed / radius)
    points = np.column_stack([x, y]).astype(np.float64) / radius
    out = np.empty((len(points), 3))
    v = padded(table.plane, table.values)
    choose(v, points, out, tables, float(v[-2, 1]))
    return speed * out[:, :2], game.turn * out[:, 2]


def standing_table(table: ChauffeurTable, response: float) -> ChauffeurTable:
    """Return the value of an evader that stands at first.

    Args:
        table: Table of the game.
        response: Time for which the evader still stands, in [s].

    Raises:
        PlanError: If the time is negative, or longer than a full turn.
    """
    game = table.game
    check_within(response, 0.0, tau / game.turn, "response", "s")
    count = max(1, ceil(response / table.period - 1e-9))
    held = response / count * game.turn
    if response == 0.0:
        return table
    tables = motion_tables(game, table.plane, held)
    tables = tables._replace(velocities=np.zeros((1, 2)))
    v = padded(table.plane, table.values)
    out, guesses = v.copy(), np.zeros((*table.plane.shape, 2))
    for _ in range(count):
        relax(v, out, guesses, tables, float(v[-2, 1]))
        v = padded(table.plane, out[1:-1, 1:-1])
    return replace(table, values=v[1:-1, 1:-1].copy())
