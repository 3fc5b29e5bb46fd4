"""Run folders: a game on disk, read and written as a whole."""

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
from .checksums import check_seal
from .configuration_file import dump_configuration, read_settings
from .duel_run import DuelRun
from .older import without_fillers
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
KINDS: dict[str, type[DuelRun] | type[WalkRun] | type[PlayRun]]
KINDS = {kind.game: kind for kind in (DuelRun, WalkRun, PlayRun)}  # by game
BROKEN = (  # what reading a file can raise, if it is not as it was written
    *(ValueError, OSError, EOFError, KeyError, NotImplementedError),
    *(BadZipFile, DeflateError, RuntimeError, MemoryError),
)


def write_record(folder: Path, run: Run) -> None:
    """Write configuration, summary and trajectories into a folder.

    Args:
        folder: It exists, and is nobody's yet.
        run: The game.
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
        folder: What somebody wrote.
        kind: What it must be a run of; of any game by default.

    Raises:
        ConfigurationError: If it is none, of another game, or of a later
            format.
    """
    folder = as_path(folder, "folder")
    if not (folder / SUMMARY).exists() and is_play(folder):
        return _of_kind(_cut_off(folder), folder, kind)
    for name in (CONFIGURATION, SUMMARY, TRAJECTORIES):
        if not (folder / name).is_file():
            raise ConfigurationError(
                f"run must be a folder with {CONFIGURATION}, {SUMMARY} and "
                f"{TRAJECTORIES}; {folder} has no {name}"
            )
    name = folder.resolve().name
    try:
        check_seal(folder, (CONFIGURATION, SUMMARY, TRAJECTORIES))
        plain = read_json(folder / SUMMARY)
        text = read_text(folder / CONFIGURATION)
        head = read_head(plain, name, tuple(KINDS))
        known = {f"{n}_{key}" for n in head.players for key in FIELDS}
        known.add("times_s")
        arrays = read_arrays(folder / TRAJECTORIES, frozenset(known))
    except ConfigurationError:
        raise
    except BROKEN as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: {error or type(error).__name__}"
        ) from error
    found = KINDS[head.game]
    if not issubclass(found, kind):
        raise ConfigurationError(
            f"run {folder} must be one of a {kind.game}, got one of a "
            f"{head.game}"
        )
    source = str(folder / CONFIGURATION)
    settings = read_settings(found.settings_kind, text, source)
    return read_record(name, settings, plain, arrays)


def _of_kind(run: Run, folder: Path, kind: type[Run]) -> Run:
    """A run, if it is one of a game."""
    if not isinstance(run, kind):
        raise ConfigurationError(
            f"run {folder} must be one of a {kind.game}, got one of a "
            f"{run.game}"
        )
    return run


def _cut_off(folder: Path) -> PlayRun:
    """What a player kept that did not come to its end, or is still at it."""
    file = folder / CONFIGURATION
    try:
        settings = read_settings(PlaySettings, read_text(file), str(file))
        return run_of_play(folder, settings)
    except ConfigurationError:
        raise
    except BROKEN as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: {error or type(error).__name__}"
        ) from error


def read_record(
    name: str, settings: Any, plain: Any, arrays: dict[str, Array]
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
    head = read_head(plain, name, tuple(KINDS))
    times, tracks = _times(arrays, name), _tracks(arrays, name, head)
    check_times(times, name)
    check_tracks(tracks, len(times), name)
    source = f"{SUMMARY} of run {name}"
    told = head.without(check_object(plain, source))
    kind: Any = KINDS[head.game]
    summary = kind.summary_kind.from_json(told, source)
    run: Run = kind(
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


def _outcome(told: str, name: str) -> Outcome:
    try:
        return Outcome(told)
    except ValueError as error:
        known = ", ".join(outcome.value for outcome in Outcome)
        raise ConfigurationError(
            f"outcome of run {name} must be one of {known}, got {told!r}"
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
    """Tracks of all players."""
    if head.version == 1:
        arrays = without_fillers(arrays, head.players)
    try:
        return tracks_in(arrays, head.players)
    except KeyError as error:
        raise ConfigurationError(
            f"{TRAJECTORIES} of run {name} has no array {error}; a player has "
            f"{', '.join(FIELDS)}"
        ) from error
