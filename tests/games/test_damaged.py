"""Test that damaged run folders are refused in one line."""

import json
import os
import struct
from collections.abc import Callable
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games.game_settings import duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.run_archive import (
    CONFIGURATION,
    SUMMARY,
    TRAJECTORIES,
    load_run,
    write_run_files,
)
from stepaside.games.trajectory import COLUMNS, OF_EVENTS, Trajectory
from stepaside.report.scene import RunScene

Damage = Callable[[Path], None]


@pytest.fixture(scope="module")
def played() -> Run:
    """Return a duel whose evader has every array."""
    run = run_game(duel(duration=0.2))
    rows: dict[str, Any] = {
        key: np.zeros((len(run.times), len(columns) or 7))
        for key, columns in COLUMNS.items()
        if getattr(run.evader, key) is None and key != "sight"
    }
    return replace(
        run, tracks={**run.tracks, "evader": replace(run.evader, **rows)}
    )


@pytest.fixture
def folder(tmp_path: Path, played: Run) -> Path:
    made = tmp_path / "run"
    made.mkdir()
    write_run_files(made, played)
    return made


def text(name: str, content: str | bytes) -> Damage:
    raw = content if isinstance(content, bytes) else content.encode()
    return lambda folder: void((folder / name).write_bytes(raw))


def void(_: Any) -> None:
    """Return nothing, whatever the argument."""


def arrays(change: Callable[[dict[str, Any]], Any]) -> Damage:
    def damage(folder: Path) -> None:
        with np.load(folder / TRAJECTORIES) as stored:
            found = {name: stored[name] for name in stored.files}
        change(found)
        np.savez_compressed(folder / TRAJECTORIES, allow_pickle=True, **found)

    return damage


def each(name: str, change: Callable[[Any], Any]) -> Damage:
    """Change one array."""
    return arrays(lambda found: found.update({name: change(found[name])}))


def put(name: str, at: Any, value: float) -> Damage:
    return arrays(lambda found: found[name].__setitem__(at, value))


def member(name: str, content: bytes) -> Damage:
    """Replace the bytes of one array in the archive."""

    def damage(folder: Path) -> None:
        with ZipFile(folder / TRAJECTORIES) as archive:
            held = {n: archive.read(n) for n in archive.namelist()}
        held[f"{name}.npy"] = content
        with ZipFile(folder / TRAJECTORIES, "w", ZIP_DEFLATED) as archive:
            for each, raw in held.items():
                archive.writestr(each, raw)

    return damage


def header(shape: str, descr: str = "'<f8'", body: bytes = b"") -> bytes:
    told = f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}"
    return (
        b"\x93NUMPY\x01\x00"
        + struct.pack("<H", len(told))
        + (told.encode() + body)
    )


def piped(name: str) -> Damage:
    def damage(folder: Path) -> None:
        (folder / name).unlink()
        os.mkfifo(folder / name)

    return damage


def empty_archive(folder: Path) -> None:
    buffer = BytesIO()
    ZipFile(buffer, "w").close()
    (folder / TRAJECTORIES).write_bytes(buffer.getvalue())


def figure(key: str, value: Any) -> Damage:
    def damage(folder: Path) -> None:
        plain = json.loads((folder / SUMMARY).read_text())
        plain[key] = value
        (folder / SUMMARY).write_text(json.dumps(plain))

    return damage


DEEP = 100_000
DAMAGES: dict[str, Damage] = {
    "summary of null": text(SUMMARY, "null"),
    "summary nested": text(SUMMARY, "[" * DEEP),
    "summary of bytes": text(SUMMARY, b"\xff\xfe"),
    "summary without end": text(SUMMARY, " " * 2**21 + "{}"),
    "summary NaN": figure("distance_m", float("nan")),
    "summary far": text(SUMMARY, '{"format": 2, "distance_m": 1e999}'),
    "summary players": figure("players", None),
    "summary text": figure("distance_m", "far"),
    "summary truth": figure("distance_m", True),
    "summary half": figure("planning", {"steps": 1, "replans": 1.5}),
    "summary theory": figure("theory", 1.0),
    "summary radius": figure("theory", {"radius_m": "wide"}),
    "summary sight": figure("sight", {"camera": "raycast"}),
    "summary message": figure("message", 3),
    "summary duration": figure("duration_s", "long"),
    "game of nobody": figure("game", "chess"),
    "a duel that was a walk": figure("game", "walk"),
    "no players": figure("players", {}),
    "players with a way": figure(
        "players", {"../pursuer": {"path_m": 1.0, "radius_m": None}}
    ),
    "configuration nested": text(CONFIGURATION, "a = " + "[" * 5000),
    "configuration long": text(CONFIGURATION, "#" * (2**20 + 1)),
    "no archive": text(TRAJECTORIES, "nothing"),
    "empty archive": empty_archive,
    "terabytes": member("times_s", header("(1000000000000,)")),
    "negative": member("times_s", header("(-1,)")),
    "objects": member("times_s", header("(1,)", "'|O'", b"\x80\x04N.")),
    "whole numbers": member("times_s", header("(1,)", "'<i8'", bytes(8))),
    "too short": member("times_s", header("(2,)", body=bytes(8))),
    "header that runs": member("times_s", header("__import__('os')")),
    "times backwards": arrays(lambda a: a.update(times_s=-a["times_s"])),
    "times NaN": put("times_s", 2, np.nan),
    "times short": arrays(lambda a: a.update(times_s=a["times_s"][:-1])),
    "configuration is a pipe": piped(CONFIGURATION),
}
NAMED = {
    "summary text": "distance_m",
    "summary truth": "finite number",
    "summary half": "replans",
    "summary theory": "theory",
    "summary radius": "radius_m",
    "summary sight": "sight",
    "summary message": "message",
    "summary duration": "duration_s",
}
for key in COLUMNS:
    if key == "sight":
        continue
    name = f"evader_{key}"
    DAMAGES[f"{name} flat"] = each(name, lambda v: v.ravel())
    if key not in OF_EVENTS:
        DAMAGES[f"{name} short"] = each(name, lambda v: v[1:])
        DAMAGES[f"{name} infinite"] = put(name, (2, 0), np.inf)


@pytest.mark.parametrize("kind", DAMAGES)
def test_a_damaged_folder_is_refused(folder: Path, kind: str) -> None:
    DAMAGES[kind](folder)
    with pytest.raises(ConfigurationError) as refused:
        load_run(folder)
    message = str(refused.value)
    assert "\n" not in message and len(message) < 600
    assert NAMED.get(kind, "") in message


def test_arrays_of_unknown_players_are_refused_by_name(folder: Path) -> None:
    arrays(lambda found: found.update(strange=np.zeros(3)))(folder)
    with pytest.raises(ConfigurationError, match="unknown array 'strange'"):
        load_run(folder)


def test_a_run_of_other_robots_has_no_scene(played: Run) -> None:
    qpos = played.pursuer.qpos
    assert qpos is not None
    track: Trajectory = replace(played.pursuer, qpos=qpos[:, :-1])
    run = replace(played, tracks={**played.tracks, "pursuer": track})
    with pytest.raises(ConfigurationError, match="columns"):
        RunScene(run)
