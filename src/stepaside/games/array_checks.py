"""Validation of the arrays of a run: shapes, rows and finite values."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from .trajectory import Trajectory

MAX_VALUE = 1e6  # of any number in a run, in [m], [rad] or [s]


class ArraySpec(NamedTuple):
    """Shape and range of one array of a player.

    Attributes:
        columns: Number of columns; None for any number from seven.
        per_sample: Whether it has one row per sample.
        may_lack: Whether values may be NaN, for missing data.
    """

    columns: int | None
    per_sample: bool = True
    may_lack: bool = False


ARRAY_SPECS = {
    "com": ArraySpec(3),
    "torso": ArraySpec(3),
    "place": ArraySpec(3),
    "com_reference": ArraySpec(2),
    "zmp_reference": ArraySpec(2),
    "zmp": ArraySpec(2, may_lack=True),
    "qpos": ArraySpec(None),
    "landings": ArraySpec(5, per_sample=False),
    "sight": ArraySpec(6, per_sample=False, may_lack=True),
    "pushes": ArraySpec(6, per_sample=False),
    "velocity": ArraySpec(2),
    "tilt": ArraySpec(2),
    "sole": ArraySpec(3),
    "support": ArraySpec(5),
    "heading_reference": ArraySpec(1),
    "estimate": ArraySpec(8, may_lack=True),
    "command": ArraySpec(6),
}


def check_times(times: Array, run: str) -> None:
    """Check that sample times are finite and strictly increasing.

    Args:
        times: Times of the samples, in [s].
        run: Name of the run, for messages.

    Raises:
        ConfigurationError: If they are not, or there are none.
    """
    if times.ndim != 1 or len(times) == 0:
        raise ConfigurationError(
            f"times_s of run {run} must be a row of at least one time [s], "
            f"got shape {times.shape}"
        )
    _check_values(times, "times_s", run, may_lack=False)
    if times[0] < 0.0 or not np.all(np.diff(times) > 0.0):
        raise ConfigurationError(
            f"times_s of run {run} must be >= 0 and increase [s]"
        )


def check_tracks(
    tracks: Mapping[str, Trajectory], samples: int, run: str
) -> None:
    """Check shapes and values of recorded trajectories.

    Args:
        tracks: Trajectories by name of the player.
        samples: Number of samples.
        run: Name of the run, for messages.

    Raises:
        ConfigurationError: If an array has another shape, or a value that
            is not finite or too large.
    """
    for player, track in tracks.items():
        for key, spec in ARRAY_SPECS.items():
            array = getattr(track, key)
            if array is not None:
                _check(array, f"{player}_{key}", spec, samples, run)


def _check(
    array: Array, name: str, spec: ArraySpec, samples: int, run: str
) -> None:
    width = array.shape[1] if array.ndim == 2 else 0
    fits = width >= 7 if spec.columns is None else width == spec.columns
    if not fits or (spec.per_sample and len(array) != samples):
        rows = samples if spec.per_sample else "any"
        columns = ">= 7" if spec.columns is None else spec.columns
        raise ConfigurationError(
            f"{name} of run {run} must have shape ({rows}, {columns}), got "
            f"{array.shape}"
        )
    _check_values(array, name, run, may_lack=spec.may_lack)


def _check_values(
    array: Array, name: str, run: str, *, may_lack: bool
) -> None:
    valid = np.abs(array) <= MAX_VALUE
    if may_lack:
        valid |= np.isnan(array)
    if not valid.all():
        raise ConfigurationError(
            f"{name} of run {run} must hold finite numbers of at most "
            f"{MAX_VALUE:g}"
        )
