"""Run folders: a duel on disk, read and written as a whole."""

import json
from dataclasses import fields
from pathlib import Path
from typing import Any
from zipfile import BadZipFile
from zlib import error as DeflateError

import numpy as np

from ..errors import ConfigurationError
from ..poses import Array
from .checking import check_times, check_tracks
from .configuration import dump_configuration, read_settings
from .figures import DuelSummary
from .outcome import Outcome
from .reading import read_arrays, read_json, read_text
from .run import Run
from .settings import PLAYERS, DuelSettings
from .track import Track, tracks_in

CONFIGURATION = "configuration.toml"
SUMMARY = "summary.json"
TRAJECTORIES = "trajectories.npz"
ARRAYS = frozenset(
    {"times_s"}
    | {f"{name}_{field.name}" for name in PLAYERS for field in fields(Track)}
)
FORMAT = 2  # of a run folder; 1 had no number and filled gaps with NaN
BROKEN = (  # what reading a file can raise, if it is not as it was written
    *(ValueError, OSError, EOFError, KeyError, NotImplementedError),
    *(BadZipFile, DeflateError, RuntimeError, MemoryError),
)


def write_record(folder: Path, run: Run) -> None:
    """Write configuration, summary and trajectories into a folder.

    Args:
        folder: It exists, and is nobody's yet.
        run: The duel.
    """
    (folder / CONFIGURATION).write_text(
        dump_configuration(run.settings), encoding="utf-8"
    )
    summary = {"format": FORMAT, **run.summary.to_json()}
    (folder / SUMMARY).write_text(
        json.dumps(summary, indent=2) + "\n", encoding="utf-8"
    )
    np.savez_compressed(
        folder / TRAJECTORIES, allow_pickle=False, **run.arrays()
    )


def load_run(folder: Path) -> Run:
    """Read a run folder.

    Raises:
        ConfigurationError: If it is none, or of a later format.
    """
    for name in (CONFIGURATION, SUMMARY, TRAJECTORIES):
        if not (folder / name).is_file():
            raise ConfigurationError(
                f"run must be a folder with {CONFIGURATION}, {SUMMARY} and "
                f"{TRAJECTORIES}; {folder} has no {name}"
            )
    try:
        plain = read_json(folder / SUMMARY)
        arrays = read_arrays(folder / TRAJECTORIES, ARRAYS)
        text = read_text(folder / CONFIGURATION)
    except BROKEN as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: {error or type(error).__name__}"
        ) from error
    source = str(folder / CONFIGURATION)
    settings = read_settings(DuelSettings, text, source)
    return read_record(folder.resolve().name, settings, plain, arrays)


def read_record(
    name: str, settings: DuelSettings, plain: Any, arrays: dict[str, Array]
) -> Run:
    """Turn what a folder holds into a run.

    Args:
        name: What the run is called.
        settings: What decided it.
        plain: Its summary, as JSON.
        arrays: Its trajectories, by name.

    Raises:
        ConfigurationError: If they are none, or of a later format.
    """
    version = _version(plain, name)
    times, tracks = _times(arrays, name), _tracks(arrays, name, version)
    check_times(times, name)
    check_tracks(tracks, len(times), name)
    summary = DuelSummary.from_json(plain, f"{SUMMARY} of run {name}")
    return Run(
        name=name,
        settings=settings,
        outcome=_outcome(summary, name),
        message=summary.message,
        duration=summary.duration_s,
        times=times,
        tracks=tracks,
        summary=summary,
    )


def _version(plain: Any, name: str) -> int:
    """Format of a folder; those without a number are of the first."""
    version = plain.get("format", 1) if isinstance(plain, dict) else 1
    if version not in range(1, FORMAT + 1):
        raise ConfigurationError(
            f"run {name} has format {version!r}; this version reads 1 to "
            f"{FORMAT}: a later stepaside wrote it"
        )
    return int(version)


def _outcome(summary: DuelSummary, name: str) -> Outcome:
    try:
        return Outcome(summary.outcome)
    except ValueError as error:
        known = ", ".join(outcome.value for outcome in Outcome)
        raise ConfigurationError(
            f"outcome of run {name} must be one of {known}, got "
            f"{summary.outcome!r}"
        ) from error


def _times(arrays: dict[str, Array], name: str) -> Array:
    if "times_s" not in arrays:
        raise ConfigurationError(
            f"{TRAJECTORIES} of run {name} has no array times_s"
        )
    return arrays["times_s"]


def _tracks(
    arrays: dict[str, Array], name: str, version: int
) -> dict[str, Track]:
    """Tracks of both players."""
    if version == 1:
        arrays = _without_fillers(arrays)
    try:
        return tracks_in(arrays, PLAYERS)
    except KeyError as error:
        names = ", ".join(field.name for field in fields(Track))
        raise ConfigurationError(
            f"{TRAJECTORIES} of run {name} has no array {error}; a player has "
            f"{names}"
        ) from error


def _without_fillers(arrays: dict[str, Array]) -> dict[str, Array]:
    """Arrays of the first format that stand for something."""
    kept = {
        key: array
        for key, array in arrays.items()
        if not _is_filler(key, array)
    }
    for name in PLAYERS:
        if f"{name}_qpos" not in kept:  # a person makes no footsteps of ours
            kept.pop(f"{name}_landings", None)
    return kept


def _is_filler(name: str, array: Array) -> bool:
    """Whether an array of the first format stands for what is not there."""
    optional = not name.endswith(("_com", "_torso", "times_s"))
    if not optional or array.dtype.kind != "f" or array.ndim != 2:
        return False
    if name.endswith("_qpos"):
        return bool(array.shape[1] == 0)
    return array.size > 0 and bool(np.isnan(array).all())
