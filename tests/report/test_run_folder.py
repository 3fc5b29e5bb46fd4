"""Run folders: whole or not at all, and what is read back from them."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError, OutputError
from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.run_archive import FORMAT, load_run
from stepaside.report import run_figure
from stepaside.report.run_folder import check_output, write_run
from stepaside.report.scene import RunScene

SETTINGS = duel(seed=3, duration=0.4, start=StartSettings(1.3, 0.4, -0.2))


@pytest.fixture(scope="module")
def result() -> Run:
    return run_game(SETTINGS)


def draw_nothing(*arguments: Any) -> None:
    arguments[-1].write_bytes(b"picture")


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_figure, "draw_run", draw_nothing)


def test_an_empty_folder_is_taken(tmp_path: Path, result: Run) -> None:
    folder = tmp_path / "empty"
    folder.mkdir()
    write_run(folder, result)
    text = (folder / "summary.json").read_text(encoding="utf-8")
    told = {"format": FORMAT, "game": "duel"}
    told |= result.results()
    assert text == json.dumps(told, indent=2) + "\n"


@pytest.mark.parametrize("error", [RuntimeError("ink"), KeyboardInterrupt()])
def test_an_error_leaves_nothing_behind(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    result: Run,
    error: BaseException,
) -> None:
    def fail(*arguments: Any) -> None:
        assert len(list(tmp_path.iterdir())) == 1  # the draft
        raise error

    monkeypatch.setattr(run_figure, "draw_run", fail)
    with pytest.raises(type(error)):
        write_run(tmp_path / "run", result)
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_told_in_one_line(
    tmp_path: Path, result: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(run_figure, "draw_run", full)
    said = "run could not be written: no space left"
    with pytest.raises(OutputError, match=said):
        write_run(tmp_path / "run", result)
    assert list(tmp_path.iterdir()) == []


def test_output_goes_where_nothing_is_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    check_output(tmp_path / "new")
    check_output(tmp_path / "a" / "b" / "c")
    empty = tmp_path / "empty"
    empty.mkdir()
    check_output(empty)
    full = tmp_path / "full"
    full.mkdir()
    file = full / "thesis.txt"
    file.write_text("x", encoding="utf-8")
    for taken in (full, file):
        with pytest.raises(ConfigurationError, match="new or an empty"):
            check_output(taken)
    with pytest.raises(ConfigurationError, match="can be written"):
        check_output(file / "below")

    def closed(**options: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryFile", closed)
    with pytest.raises(ConfigurationError, match="can be written"):
        check_output(tmp_path / "new")


@pytest.mark.parametrize(
    "name", ["configuration.toml", "summary.json", "trajectories.npz"]
)
def test_a_folder_that_lacks_a_file_is_no_run(
    tmp_path: Path, result: Run, name: str
) -> None:
    folder = tmp_path / "run"
    write_run(folder, result)
    (folder / name).unlink()
    with pytest.raises(ConfigurationError, match=f"has no {name}"):
        load_run(folder)


def test_the_stage_puts_the_bodies_where_they_were(result: Run) -> None:
    """At every sample: torsos, CoMs and the cameras of the bodies."""
    tracks = {}
    for name in ("pursuer", "evader"):
        track = result.tracks[name]
        assert track.qpos is not None
        moved = track.qpos.copy()
        moved[:, 0] += np.linspace(0.0, 1.0, len(moved))
        moved[:, 9] += np.linspace(0.0, 0.3, len(moved))
        tracks[name] = replace(track, qpos=moved)
    stage = RunScene(replace(result, tracks=tracks))
    torsos = [stage.model.body(f"{n}/torso").id for n in ("pursuer", "evader")]
    for index in (0, 7, len(result.times) - 1, 3):
        stage.put(index)
        postures = [
            track.qpos[index]
            for track in tracks.values()
            if track.qpos is not None
        ]
        np.testing.assert_allclose(stage.data.qpos, np.concatenate(postures))
        for torso, posture in zip(torsos, postures, strict=True):
            np.testing.assert_allclose(
                stage.data.xpos[torso], posture[:3], atol=1e-6
            )
