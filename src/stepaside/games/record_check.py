"""Checks of arrays that a run is made of, read from files."""

from collections.abc import Mapping

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from .trajectory import COLUMNS, MAY_LACK, OF_EVENTS, Trajectory


def check_record(
    times: Array, tracks: Mapping[str, Trajectory], run: str
) -> None:
    """Check times, and shapes and values of trajectories.

    Raises:
        ConfigurationError: If times do not increase, an array has another
            shape, or a value is not finite.
    """
    if times.ndim != 1 or len(times) == 0:
        raise ConfigurationError(
            f"times_s of run {run} must be a row of at least one time [s], "
            f"got shape {times.shape}"
        )
    _check_values(times, "times_s", run)
    if times[0] < 0.0 or not np.all(np.diff(times) > 0.0):
        raise ConfigurationError(
            f"times_s of run {run} must be >= 0 and increase [s]"
        )
    for player, track in tracks.items():
        for key, array in track.arrays().items():
            shape = array.shape if array.ndim == 2 else (-1, 0)
            rows = shape[0] if key in OF_EVENTS else len(times)
            least = 7 if key == "qpos" else 0
            width = len(COLUMNS[key]) or max(least, shape[1])
            if shape != (rows, width):
                raise ConfigurationError(
                    f"{player}_{key} of run {run} must have shape "
                    f"({rows}, {width}), got {array.shape}"
                )
            _check_values(array, f"{player}_{key}", run, key in MAY_LACK)


def _check_values(
    array: Array, name: str, run: str, may_lack: bool = False
) -> None:
    valid = np.isfinite(array)
    if may_lack:
        valid |= np.isnan(array)
    if not valid.all():
        raise ConfigurationError(f"{name} of run {run} must be finite numbers")
