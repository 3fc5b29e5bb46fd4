"""Compiled Runge-Kutta stage over the grid, in parallel over planes of a.

Arrays have ghost cells (:mod:`.state_grid`). The innermost loops run along
psi without branches, so that the compiler vectorises them; the rows of
slopes between them stay in the first-level cache.
"""

from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import (
    compiled,
    compiled_parallel,
    copy_values,
    parallel_range,
)
from .upwind_scheme import upwind, weno5

REACH = 3 * 3  # rows along a and r that a step reaches: three stages
prange = parallel_range()


class StageParameters(NamedTuple):
    """Parameters of a game on a grid, for compiled loops.

    Attributes:
        pursuer: Forward and sideways speed of the pursuer along the line of
            sight, its turning rate by its law, how far it may deviate.
            Shape (a, 4).
        distance: Distances of the rows. Shape (r,).
        inverse: Inverse distances of the rows. Shape (r,).
        forward: Speed of the evader along the line of sight. Shape (psi,).
        sideways: Speed of the evader across it. Shape (psi,).
        reach: Largest turning rate of the evader.
        scale: One over the spacings along r, a and psi. Shape (3,).
        smooth: Twelve times the squares of differences that count as smooth.
            Shape (3,).
    """

    pursuer: Any
    distance: Any
    inverse: Any
    forward: Any
    sideways: Any
    reach: Any
    scale: Any
    smooth: Any


class RowStates(NamedTuple):
    """Rows that one step may change, and those that it has changed.

    Attributes:
        active: Rows that may change in this step. Shape (a, r).
        changed: Output of the last stage: rows that changed. Shape (a, r).
        still: Change that counts as none, in [m].
    """

    active: Any
    changed: Any
    still: Any


@compiled
def row_slopes(
    v: Any, at: int, stride: int, scale: Any, smooth: Any, left: Any,
    right: Any,
) -> None:  # fmt: skip
    """Compute one-sided slopes of one row.

    Args:
        v: All values, flat.
        at: Index of the first value of the row.
        stride: Index distance of neighbours along the axis.
        scale: One over the spacing.
        smooth: See :class:`StageParameters`.
        left: Output: slopes to the left.
        right: Output: slopes to the right.
    """
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
    reach: Any, out: Any,
) -> None:  # fmt: skip
    """Compute the rates of the values of one row."""
    ahead, across, turn, freedom = pursuer
    for k in range(out.shape[0]):
        out[k] = upwind(
            forward[k] - ahead, (across - sideways[k]) * inverse, turn,
            freedom, reach,
            (s[0, k], s[1, k], s[2, k], s[3, k], s[4, k], s[5, k]),
        )  # fmt: skip


@compiled
def blend(
    first: Any, now: Any, rate: Any, keep: Any, step: Any, out: Any
) -> None:
    """Compute one Runge-Kutta stage of one row."""
    gain = np.float32(1.0) - keep
    for k in range(rate.shape[0]):
        m = k + 3
        out[m] = keep * first[m] + gain * (now[m] + step * rate[k])


@compiled
def clip_row(first: Any, out: Any, low: Any, high: Any, still: Any) -> bool:
    """Clip a row between two values; return whether it has changed.

    The least distance of a game is at most its current distance, and at
    least the distance at which the game ends.
    """
    changed = False
    for k in range(3, out.shape[0] - 3):
        x = out[k]
        x = x if x < high else high
        x = x if x > low else low
        out[k] = x
        changed |= abs(x - first[k]) > still
    return changed


@compiled_parallel
def stage_blocks(
    first: Any,
    now: Any,
    out: Any,
    keep: Any,
    step: Any,
    last: bool,
    setting: StageParameters,
    rows: RowStates,
) -> None:
    """Compute one Runge-Kutta stage for the active rows.

    Args:
        first: Values at the begin of the step, with ghosts.
        now: Values of the previous stage, with ghosts.
        out: Output: new values; ghosts are not written.
        keep: Weight of ``first`` in the new values.
        step: Time step, in [s].
        last: Whether this is the last stage of the step.
        setting: Parameters of the game on the grid.
        rows: Rows that may change; those that change are marked.
    """
    active, changed, still = rows
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
            if not active[i, j]:
                copy_values(before, after)
                changed[i, j] = False
                continue
            at = (i + 3) * plane + (j + 3) * line + 3
            for axis in range(3):
                left, right = s[2 * axis], s[2 * axis + 1]
                stride, scale = strides[axis], setting.scale[axis]
                smooth = setting.smooth[axis]
                row_slopes(flat, at, stride, scale, smooth, left, right)
            row_rates(
                s, pursuer, setting.inverse[j], setting.forward,
                setting.sideways, setting.reach, rate,
            )  # fmt: skip
            blend(before, now[i + 3, j + 3], rate, keep, step, after)
            if last:
                changed[i, j] = clip_row(
                    before, after, setting.distance[0], setting.distance[j],
                    still,
                )  # fmt: skip


def mark_active_rows(changed: Any, active: Any) -> bool:
    """Find the rows that a step may change, from those of the last step.

    The mirror image beyond the edges of a reaches no further row.

    Args:
        changed: Rows that changed in the previous step. Shape (a, r).
        active: Output: rows that may change in this step. Shape (a, r).

    Returns:
        Whether any row is active.
    """
    active[:] = changed
    for axis in (active, active.T):
        reached = axis.copy()
        for n in range(1, min(REACH + 1, len(axis))):
            axis[n:] |= reached[:-n]
            axis[:-n] |= reached[n:]
    return bool(active.any())
