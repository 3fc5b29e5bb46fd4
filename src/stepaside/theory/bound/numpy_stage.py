"""Runge-Kutta stage over the grid in NumPy, without Numba."""

from typing import Any

import numpy as np

from .compiled_stage import FIFTH, RowStates, StageParameters
from .upwind_scheme import lax_friedrichs, upwind, weno5


def stage_arrays(
    first: Any,
    now: Any,
    out: Any,
    keep: Any,
    step: Any,
    last: bool,
    setting: StageParameters,
    rows: RowStates,
) -> None:
    """Compute one stage; see :func:`.compiled_stage.stage_blocks`."""
    inner = (slice(3, -3),) * 3
    slopes: list[Any] = []
    for axis, number in ((1, 0), (0, 1), (2, 2)):
        a, b, c, d, e, f, g = (_shifted(now, axis, n) for n in range(-3, 4))
        if setting.order == FIFTH:
            pair = weno5(a, b, c, d, e, f, g, setting.smooth[number])
        else:
            pair = d - c, e - d
        slopes += [setting.scale[number] * slope for slope in pair]
    ahead, across, turn, freedom = setting.pursuer.T[:, :, None, None]
    rate = (upwind if setting.godunov else lax_friedrichs)(
        setting.forward - ahead,
        (across - setting.sideways) * setting.inverse[:, None],
        turn,
        freedom,
        setting.reach,
        tuple(slopes),
    )
    gain = np.float32(1.0) - keep
    made = keep * first[inner] + gain * (now[inner] + step * rate)
    if last:
        high = setting.distance[:, None]
        made = np.maximum(np.minimum(made, high), setting.distance[0])
        moved = (np.abs(made - first[inner]) > rows.still).any(axis=2)
        rows.changed[:] = rows.active & moved
    out[inner] = np.where(rows.active[:, :, None], made, first[inner])


def _shifted(v: Any, axis: int, by: int) -> Any:
    """Return the view without ghosts, shifted along one axis."""
    window = [slice(3, -3)] * 3
    end = v.shape[axis] - 3 + by
    window[axis] = slice(3 + by, end)
    return v[tuple(window)]
