"""Compiled loops over the grid: planes of equal a on all cores.

Arrays have ghost cells around them (:mod:`.grid`). The innermost loops run
along psi, without a branch, so that the compiler turns them into vector
instructions; the rows of slopes between them stay in the first cache.
"""

from typing import Any, NamedTuple

import numpy as np

from ..unicycle.compilation import compiled, compiled_parallel, parallel_range
from .upwind_scheme import lax_friedrichs, upwind, weno5

FIRST, FIFTH = 1, 5
prange = parallel_range()


class StageParameters(NamedTuple):
    """What a game and a grid are to the loops.

    Attributes:
        pursuer: Forward and sideways speed of the pursuer along the line of
            sight, its turning rate by its law, how far it may deviate.
            Shape (a, 4).
        distance: Distances of the rows. Shape (r,).
        inverse: One over them. Shape (r,).
        forward: Speed of the evader along the line of sight. Shape (psi,).
        sideways: The same across it. Shape (psi,).
        reach: Largest turning rate of the evader.
        scale: One over the spacings along r, a and psi. Shape (3,).
        smooth: Twelve times the squares of differences that count as smooth.
            Shape (3,).
        order: FIRST or FIFTH.
        godunov: Whether the flux is Godunov's rather than Lax's.
    """

    pursuer: Any
    distance: Any
    inverse: Any
    forward: Any
    sideways: Any
    reach: Any
    scale: Any
    smooth: Any
    order: int
    godunov: bool


@compiled
def first_slopes(
    v: Any, at: int, stride: int, scale: Any, left: Any, right: Any
) -> None:
    """Write one-sided slopes of first order of one row.

    Args:
        v: All values, flat.
        at: Where the row begins in them.
        stride: How far neighbours along the axis are apart in them.
        scale: One over the spacing.
        left: Where the slopes to the left are written.
        right: The same to the right.
    """
    n = left.shape[0]
    a, b = v[at - stride : at - stride + n], v[at : at + n]
    c = v[at + stride : at + stride + n]
    for k in range(n):
        left[k], right[k] = scale * (b[k] - a[k]), scale * (c[k] - b[k])


@compiled
def fifth_slopes(
    v: Any, at: int, stride: int, scale: Any, smooth: Any, left: Any,
    right: Any,
) -> None:  # fmt: skip
    """Write one-sided slopes of fifth order; see :func:`first_slopes`."""
    n = left.shape[0]
    begin = at - 3 * stride
    a, b = v[begin : begin + n], v[begin + stride : begin + stride + n]
    c, d = v[at - stride : at - stride + n], v[at : at + n]
    begin = at + stride
    e, f = v[begin : begin + n], v[begin + stride : begin + stride + n]
    begin = at + 3 * stride
    g = v[begin : begin + n]
    for k in range(n):
        x, y = weno5(a[k], b[k], c[k], d[k], e[k], f[k], g[k], smooth)
        left[k], right[k] = scale * x, scale * y


@compiled
def row_rates(
    s: Any, pursuer: Any, inverse: Any, forward: Any, sideways: Any,
    reach: Any, godunov: bool, out: Any,
) -> None:  # fmt: skip
    """Write how fast the values of one row change."""
    ahead, across, turn, freedom = pursuer
    if godunov:
        for k in range(out.shape[0]):
            out[k] = upwind(
                forward[k] - ahead, (across - sideways[k]) * inverse, turn,
                freedom, reach,
                (s[0, k], s[1, k], s[2, k], s[3, k], s[4, k], s[5, k]),
            )  # fmt: skip
    else:
        for k in range(out.shape[0]):
            out[k] = lax_friedrichs(
                forward[k] - ahead, (across - sideways[k]) * inverse, turn,
                freedom, reach,
                (s[0, k], s[1, k], s[2, k], s[3, k], s[4, k], s[5, k]),
            )  # fmt: skip


@compiled
def blend(
    first: Any, now: Any, rate: Any, keep: Any, step: Any, out: Any
) -> None:
    """Write one stage of Runge's and Kutta's method for one row."""
    gain = np.float32(1.0) - keep
    for k in range(rate.shape[0]):
        m = k + 3
        out[m] = keep * first[m] + gain * (now[m] + step * rate[k])


@compiled
def confine(first: Any, out: Any, low: Any, high: Any, still: Any) -> bool:
    """Hold a row between two values; say whether it has moved.

    The least distance so far is at most the distance now, and a game that
    has ended keeps what it ended with.
    """
    moved = False
    for k in range(3, out.shape[0] - 3):
        x = out[k]
        x = x if x < high else high
        x = x if x > low else low
        out[k] = x
        moved |= abs(x - first[k]) > still
    return moved


@compiled_parallel
def stage_blocks(
    first: Any, now: Any, out: Any, keep: Any, step: Any, last: bool,
    setting: StageParameters, awake: Any, moved: Any, still: Any,
) -> None:  # fmt: skip
    """Do one stage of a step for the rows that are awake.

    Args:
        first: Values at the beginning of the step, with ghosts.
        now: Values of the stage before, with ghosts.
        out: Where the new ones are written; its ghosts are not.
        keep: Share of ``first`` in them.
        step: Step, in [s].
        last: Whether the step ends with this stage.
        setting: The game on the grid.
        awake: Which rows may change in this step. Shape (a, r).
        moved: Which rows did; written by the last stage. Shape (a, r).
        still: Change that counts as none, in [m].
    """
    flat = now.reshape(-1)
    width, line = now.shape[2] - 6, now.shape[2]
    plane = now.shape[1] * line
    strides = (line, plane, 1)  # along r, a, psi
    for i in prange(now.shape[0] - 6):
        s = np.empty((6, width), now.dtype)
        rate = np.empty(width, now.dtype)
        p = setting.pursuer[i]
        pursuer = (p[0], p[1], p[2], p[3])
        for j in range(now.shape[1] - 6):
            before, after = first[i + 3, j + 3], out[i + 3, j + 3]
            if not awake[i, j]:
                after[:] = before
                moved[i, j] = False
                continue
            at = (i + 3) * plane + (j + 3) * line + 3
            for axis in range(3):
                left, right = s[2 * axis], s[2 * axis + 1]
                stride, scale = strides[axis], setting.scale[axis]
                if setting.order == FIFTH:
                    smooth = setting.smooth[axis]
                    fifth_slopes(flat, at, stride, scale, smooth, left, right)
                else:
                    first_slopes(flat, at, stride, scale, left, right)
            row_rates(
                s, pursuer, setting.inverse[j], setting.forward,
                setting.sideways, setting.reach, setting.godunov, rate,
            )  # fmt: skip
            blend(before, now[i + 3, j + 3], rate, keep, step, after)
            if last:
                moved[i, j] = confine(
                    before, after, setting.distance[0], setting.distance[j],
                    still,
                )  # fmt: skip


@compiled
def wake_neighbours(moved: Any, awake: Any, arm: int, times: int) -> bool:
    """Find the rows that a step may change, given those that just moved.

    A stage looks ``arm`` rows far along a and r, and a step has ``times`` of
    them. Beyond the edges of a lies the mirror image, which reaches no row
    that is not reached on this side.

    Args:
        moved: Rows that changed in the step before. Shape (a, r).
        awake: Rows that may change in this one; written. Shape (a, r).
        arm: Reach of one stage, in rows.
        times: Stages of a step.

    Returns:
        Whether there is any.
    """
    planes, rows = moved.shape
    awake[:] = moved
    for _ in range(times):
        reached = awake.copy()
        for i in range(planes):
            for j in range(rows):
                if not reached[i, j]:
                    continue
                for n in range(-arm, arm + 1):
                    if 0 <= i + n < planes:
                        awake[i + n, j] = True
                    if 0 <= j + n < rows:
                        awake[i, j + n] = True
    return bool(awake.any())
