"""Run folders: a recorded game on disk."""

import json
from pathlib import Path
from typing import Any, TypeVar, overload
from zipfile import BadZipFile
from zlib import error as DeflateError

import numpy as np

from ..core.errors import AnyPath, ConfigurationError, as_path
from ..core.poses import Array
from .archive_reader import read_arrays, read_json, read_text
from .array_checks import check_times, check_tracks
from .checksums import check_checksums
from .configuration_file import dump_configuration, read_settings
from .duel_run import DuelRun
from .outcome import Outcome
from .play_conversion import is_play, run_of_play
from .play_run import PlayRun
from .play_settings import PlaySettings
from .run import Run
from .run_header import FORMAT, RunHeader, read_head
from .summary_parsing import check_object
from .trajectory import FIELDS, Trajectory, tracks_in
from .walk_run import WalkRun

R = TypeVar("R", bound=Run)

CONFIGURATION = "configuration.toml"
SUMMARY = "summary.json"
TRAJECTORIES = "trajectories.npz"
RUN_CLASSES: dict[str, type[DuelRun] | type[WalkRun] | type[PlayRun]]
RUN_CLASSES = {run.game: run for run in (DuelRun, WalkRun, PlayRun)}
READ_ERRORS = (  # raised for damaged files
    ValueError,
    OSError,
    EOFError,
    KeyError,
    NotImplementedError,
    BadZipFile,
    DeflateError,
    RuntimeError,
    MemoryError,
)


def write_run_files(folder: Path, run: Run) -> None:
    """Write configuration, summary and trajectories into a folder.

    Args:
        folder: Existing folder without a run.
        run: The run.
    """
    (folder / CONFIGURATION).write_text(
        dump_configuration(run.settings), encoding="utf-8"
    )
    head = RunHeader(FORMAT, run.game, run.players)
    summary = {**head.to_json(), **run.summary.to_json()}
    (folder / SUMMARY).write_text(
        json.dumps(summary, indent=2) + "\n", encoding="utf-8"
    )
    np.savez_compressed(
        folder / TRAJECTORIES, allow_pickle=False, **run.arrays()
    )


@overload
def load_run(folder: AnyPath) -> Run: ...
@overload
def load_run(folder: AnyPath, kind: type[R]) -> R: ...
def load_run(folder: AnyPath, kind: type[Run] = Run) -> Run:
    """Read a run folder.

    Args:
        folder: The run folder.
        kind: Required class of the run; by default that of any game.

    Returns:
        The run.

    Raises:
        ConfigurationError: If the folder is not a valid run folder, of
            another game, or of another format.
    """
    folder = as_path(folder, "folder")
    if not (folder / SUMMARY).exists() and is_play(folder):
        _check_game(PlayRun, folder, kind)
        return _load_unfinished_play(folder)
    for name in (CONFIGURATION, SUMMARY, TRAJECTORIES):
        if not (folder / name).is_file():
            raise ConfigurationError(
                f"run must be a folder with {CONFIGURATION}, {SUMMARY} and "
                f"{TRAJECTORIES}; {folder} has no {name}"
            )
    name = folder.resolve().name
    try:
        check_checksums(folder, (CONFIGURATION, SUMMARY, TRAJECTORIES))
        plain = read_json(folder / SUMMARY)
        text = read_text(folder / CONFIGURATION)
        head = read_head(plain, name, tuple(RUN_CLASSES))
        known = {f"{n}_{key}" for n in head.players for key in FIELDS}
        known.add("times_s")
        arrays = read_arrays(folder / TRAJECTORIES, frozenset(known))
    except ConfigurationError:
        raise
    except READ_ERRORS as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: {error or type(error).__name__}"
        ) from error
    run_class = RUN_CLASSES[head.game]
    _check_game(run_class, folder, kind)
    source = str(folder / CONFIGURATION)
    settings = read_settings(run_class.settings_kind, text, source)
    return read_record(name, settings, plain, arrays)


def _check_game(run_class: type[Run], folder: Path, kind: type[Run]) -> None:
    if not issubclass(run_class, kind):
        raise ConfigurationError(
            f"run {folder} must be one of a {kind.game}, got one of a "
            f"{run_class.game}"
        )


def _load_unfinished_play(folder: Path) -> PlayRun:
    """Read a play that was cut off or is still running."""
    file = folder / CONFIGURATION
    try:
        settings = read_settings(PlaySettings, read_text(file), str(file))
        return run_of_play(folder, settings)
    except ConfigurationError:
        raise
    except READ_ERRORS as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: {error or type(error).__name__}"
        ) from error


def read_record(
    name: str, settings: Any, plain: Any, arrays: dict[str, Array]
) -> Run:
    """Build a run from the content of a run folder.

    Args:
        name: Name of the run.
        settings: Settings of the game.
        plain: Summary, as JSON.
        arrays: Arrays of the trajectories, by name.

    Raises:
        ConfigurationError: If the content is invalid, or of another format.
    """
    head = read_head(plain, name, tuple(RUN_CLASSES))
    times, tracks = _times(arrays, name), _tracks(arrays, name, head)
    check_times(times, name)
    check_tracks(tracks, len(times), name)
    source = f"{SUMMARY} of run {name}"
    entries = head.without(check_object(plain, source))
    run_class: Any = RUN_CLASSES[head.game]
    summary = run_class.summary_kind.from_json(entries, source)
    run: Run = run_class(
        name=name,
        settings=settings,
        outcome=_outcome(summary.outcome, name),
        message=summary.message,
        duration=summary.duration_s,
        times=times,
        tracks=tracks,
        summary=summary,
    )
    return run


def _outcome(value: str, name: str) -> Outcome:
    try:
        return Outcome(value)
    except ValueError as error:
        known = ", ".join(outcome.value for outcome in Outcome)
        raise ConfigurationError(
            f"outcome of run {name} must be one of {known}, got {value!r}"
        ) from error


def _times(arrays: dict[str, Array], name: str) -> Array:
    if "times_s" not in arrays:
        raise ConfigurationError(
            f"{TRAJECTORIES} of run {name} has no array times_s"
        )
    return arrays["times_s"]


def _tracks(
    arrays: dict[str, Array], name: str, head: RunHeader
) -> dict[str, Trajectory]:
    """Return the trajectories of all players."""
    try:
        return tracks_in(arrays, head.players)
    except KeyError as error:
        raise ConfigurationError(
            f"{TRAJECTORIES} of run {name} has no array {error}; arrays of a "
            f"player are {', '.join(FIELDS)}"
        ) from error
