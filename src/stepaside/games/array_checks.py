"""What the arrays of a run are like: shapes, rows and numbers."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from .trajectory import Trajectory

FARTHEST = 1e6  # of any number in a run, in [m], [rad] or [s]


class ArraySpec(NamedTuple):
    """What an array of a player is like.

    Attributes:
        columns: How many it has; None for any number from seven.
        per_sample: Whether it has a row for each sample.
        may_lack: Whether a number may be NaN, for what was not there.
    """

    columns: int | None
    per_sample: bool = True
    may_lack: bool = False


KINDS = {
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
    "command": ArraySpec(4),
}


def check_times(times: Array, run: str) -> None:
    """Refuse times that do not go on.

    Args:
        times: Of the samples, in [s].
        run: Name of the run, for messages.

    Raises:
        ConfigurationError: If they are none.
    """
    if times.ndim != 1 or len(times) == 0:
        raise ConfigurationError(
            f"times_s of run {run} must be a row of at least one time [s], "
            f"got shape {times.shape}"
        )
    _check_numbers(times, "times_s", run, may_lack=False)
    if times[0] < 0.0 or not np.all(np.diff(times) > 0.0):
        raise ConfigurationError(
            f"times_s of run {run} must be >= 0 and increase [s]"
        )


def check_tracks(
    tracks: Mapping[str, Trajectory], samples: int, run: str
) -> None:
    """Refuse tracks that are not as tracks are.

    Args:
        tracks: By name of the player.
        samples: Rows that each has.
        run: Name of the run, for messages.

    Raises:
        ConfigurationError: If an array has another shape, or a number that
            is none.
    """
    for player, track in tracks.items():
        for key, kind in KINDS.items():
            array = getattr(track, key)
            if array is not None:
                _check(array, f"{player}_{key}", kind, samples, run)


def _check(
    array: Array, name: str, kind: ArraySpec, samples: int, run: str
) -> None:
    wide = array.shape[1] if array.ndim == 2 else 0
    fits = wide >= 7 if kind.columns is None else wide == kind.columns
    if not fits or (kind.per_sample and len(array) != samples):
        rows = samples if kind.per_sample else "any"
        columns = ">= 7" if kind.columns is None else kind.columns
        raise ConfigurationError(
            f"{name} of run {run} must have shape ({rows}, {columns}), got "
            f"{array.shape}"
        )
    _check_numbers(array, name, run, may_lack=kind.may_lack)


def _check_numbers(
    array: Array, name: str, run: str, *, may_lack: bool
) -> None:
    right = np.abs(array) <= FARTHEST
    if may_lack:
        right |= np.isnan(array)
    if not right.all():
        raise ConfigurationError(
            f"{name} of run {run} must hold finite numbers of at most "
            f"{FARTHEST:g}"
        )
