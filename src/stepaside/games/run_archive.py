"""Run folders: a recorded game on disk."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from shutil import copy, copytree
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile
from zlib import error as DeflateError

import numpy as np
import tomli_w

from ..core.entries import load_entries, read_entries
from ..core.errors import AnyPath, ConfigurationError, as_path
from ..core.poses import Array
from ..robots.description import FILE, known_robots
from .game import Outcome
from .game_settings import GAME_KINDS
from .player_settings import MOST_PLAYERS, PLAYER_NAME
from .run import Run
from .settings_reader import (
    ROBOTS,
    load_settings,
    replace_files,
    settings_entries,
)
from .summary import Summary
from .trajectory import COLUMNS, MAY_LACK, OF_EVENTS, Trajectory

if TYPE_CHECKING:
    from .play_settings import PlaySettings

FORMAT = 5  # of a run folder
CONFIGURATION = "configuration.toml"
SUMMARY = "summary.json"
TRAJECTORIES = "trajectories.npz"
CHECKSUMS = "checksums.txt"
READ_ERRORS = (  # raised for damaged files
    *(ValueError, OSError, EOFError, KeyError, RuntimeError, MemoryError),
    *(BadZipFile, DeflateError),
)
KINDS = {
    **dict.fromkeys(GAME_KINDS, "game_settings:GameSettings"),
    "play": "play_settings:PlaySettings",
    "experiment": "experiment:ExperimentSettings",
}
"""Module and class of the settings, by kind of game."""


@dataclass(frozen=True, slots=True)
class RunHeader:
    """Entries of a summary file beside the summary."""

    outcome: str
    message: str
    duration_s: float


def write_run_files(folder: Path, run: Run) -> None:
    """Write configuration, summary and trajectories into a folder.

    Descriptions and networks of robots that are not part of stepaside are
    copied into it, so that it opens on any computer.
    """
    entries = settings_entries(run.settings)
    _keep_robots(entries, folder)
    header = {"format": FORMAT, "game": run.game}
    summary = json.dumps(header | run.results(), indent=2, allow_nan=False)
    file = folder / TRAJECTORIES
    np.savez_compressed(file, allow_pickle=False, **run.arrays())
    (folder / CONFIGURATION).write_text(tomli_w.dumps(entries), "utf-8")
    (folder / SUMMARY).write_text(summary + "\n", "utf-8")


def _keep_robots(entries: Any, folder: Path) -> None:
    """Copy robots and networks that entries name, and name the copies."""
    kept: dict[Path, str] = {}

    def keep(value: str) -> str:
        source = Path(value).resolve()
        if value in ("", *known_robots()) or not source.exists():
            return value
        if source not in kept:
            # A measured response is named like its network.
            kept[source] = f"{ROBOTS}/{len(kept) + 1}/{source.name}"
            target = folder / kept[source]
            target.parent.mkdir(parents=True)
            if source.is_dir():
                copytree(source, target, symlinks=False)
                _find_model(source, target)
            else:
                copy(source, target)
                if (weights := Path(f"{source}.data")).exists():
                    copy(weights, target.parent)
        return kept[source]

    replace_files(entries, keep)


def _find_model(source: Path, copied: Path) -> None:
    """Name the model of a copied description, wherever it lies."""
    file = copied / FILE
    model = load_entries(source / FILE).get("model", "")
    if not (copied / model).exists():
        found = json.dumps(str((source / model).resolve()))
        text = file.read_text("utf-8").replace(json.dumps(model), found, 1)
        file.write_text(text, "utf-8")


def complete_play(
    folder: Path, settings: "PlaySettings", outcome: Outcome, message: str
) -> Run:
    """Complete the run folder of a player that has ended.

    Summary and trajectories are added. No figure is drawn, as the
    computer of a robot need not have matplotlib.
    """
    from .play_conversion import run_of_play

    run = run_of_play(folder, settings, outcome, message)
    check_record(run.times, run.tracks, run.name)
    write_run_files(folder, run)
    write_checksums(folder)
    return run


def load_run(folder: AnyPath, game: str | None = None) -> Run:
    """Read a run folder, of any game or of a required one.

    Games are "duel", "game", "walk", "play" and "experiment".

    Raises:
        ConfigurationError: If the folder is not a valid run folder, of
            another game, or of another format.
    """
    from .play_conversion import has_play_rows, run_of_play

    folder = as_path(folder, "folder")
    try:
        if not (folder / SUMMARY).exists() and has_play_rows(folder):
            entries = load_entries(folder / CONFIGURATION)
            source = str(folder / CONFIGURATION)
            settings = _read_settings("play", entries, source)
            run = run_of_play(folder, settings)
        else:
            run = _load_complete_run(folder)
        check_record(run.times, run.tracks, run.name)
    except ConfigurationError:
        raise
    except READ_ERRORS as error:
        raise ConfigurationError(
            f"run {folder} cannot be read: "
            + (str(error).partition("\n")[0] or type(error).__name__)
        ) from error
    if game not in (None, run.game):
        raise ConfigurationError(
            f"run {folder} must be one of a {game}, got one of a {run.game}"
        )
    return run


def _read_settings(game: str, entries: dict[str, Any], source: str) -> Any:
    module, _, name = KINDS[game].partition(":")
    kind = getattr(import_module(f".{module}", __package__), name)
    return read_entries(kind, entries, source)


def _load_complete_run(folder: Path) -> Run:
    for name in (CONFIGURATION, SUMMARY, TRAJECTORIES):
        if not (folder / name).is_file():
            raise ConfigurationError(
                f"run must be a folder with {CONFIGURATION}, {SUMMARY} and "
                f"{TRAJECTORIES}; {folder} has no {name}"
            )
    check_checksums(folder)
    plain = load_entries(folder / SUMMARY)
    for key, known in (("format", [FORMAT]), ("game", [*KINDS])):
        value = plain.get(key)
        if type(value) is not type(known[0]) or value not in known:
            raise ConfigurationError(
                f"{key} of run {folder} must be "
                f"{' or '.join(map(str, known))}, got {value!r:.40}"
            )
    with np.load(folder / TRAJECTORIES, allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    entries = load_settings(folder / CONFIGURATION)
    source = str(folder / CONFIGURATION)
    settings = _read_settings(plain["game"], entries, source)
    if settings.game != plain["game"]:
        raise ConfigurationError(
            f"game of run {folder} must be {settings.game}, as in "
            f"{CONFIGURATION}, got {plain['game']!r}"
        )
    return read_record(folder.resolve().name, settings, plain, arrays)


def read_record(
    name: str, settings: Any, plain: dict[str, Any], arrays: dict[str, Array]
) -> Run:
    """Build a run from the content of a run folder."""
    source = f"{SUMMARY} of run {name}"
    about = read_entries(RunHeader, plain, source, ignoring=True)
    summary = read_entries(Summary, plain, source, ignoring=True)
    players = tuple(summary.players)
    named = all(map(PLAYER_NAME.fullmatch, players))
    if not named or not 1 <= len(players) <= MOST_PLAYERS:
        raise ConfigurationError(
            f"players of run {name} must be 1 to {MOST_PLAYERS} names in "
            f"lower case, got {[*players]!r:.80}"
        )
    required = {f"{n}_{key}" for n in players for key in ("com", "torso")}
    missing = (required | {"times_s"}) - arrays.keys()
    known = {f"{n}_{key}" for n in players for key in COLUMNS}
    unknown = arrays.keys() - known - {"times_s"}
    for names, what in ((missing, "has no"), (unknown, "holds an unknown")):
        if names:
            raise ConfigurationError(
                f"{TRAJECTORIES} of run {name} {what} array "
                f"{min(names)!r:.40}; arrays are times_s and, of each "
                f"player, {', '.join(COLUMNS)}"
            )
    tracks = {}
    for n in players:
        own: Any = {key: arrays.get(f"{n}_{key}") for key in COLUMNS}
        tracks[n] = Trajectory(**own)
    return Run(
        name=name,
        settings=settings,
        outcome=Outcome(about.outcome),
        message=about.message,
        duration=about.duration_s,
        times=arrays["times_s"],
        tracks=tracks,
        summary=summary,
    )


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


def write_checksums(folder: Path) -> None:
    """Write the SHA-256 checksums of files, as ``sha256sum`` does."""
    files = [file for file in sorted(folder.iterdir()) if file.is_file()]
    lines = [f"{_checksum(file)}  {file.name}\n" for file in files]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8")


def check_checksums(folder: Path) -> None:
    """Check files against their checksums; one edited by hand has none."""
    if not (folder / CHECKSUMS).exists():
        return
    for line in (folder / CHECKSUMS).read_text("utf-8").splitlines():
        recorded, _, name = line.partition("  ")
        file = folder / name
        if file.is_file() and _checksum(file) != recorded:
            raise ConfigurationError(
                f"{name} of run {folder} was modified: its checksum differs "
                f"from that in {CHECKSUMS}; delete {CHECKSUMS} to read the "
                "folder unchecked"
            )


def _checksum(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()
