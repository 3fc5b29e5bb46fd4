"""Test walks as runs: stored, drawn, replayed and compared."""

import json
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.outcome import Outcome
from stepaside.games.recorded_game import run_duel, run_walk
from stepaside.games.run import WalkRun
from stepaside.games.run_archive import load_run, write_run_files
from stepaside.games.walk_settings import WalkSettings
from stepaside.report.run_folder import write_run
from stepaside.report.scene import RunScene
from stepaside.sim.push import Push
from synthetic_run import check_same

PUSHES = (Push(0.5, 1.0, pi / 2), Push(0.4, 1.1, 0.0))


@pytest.fixture(scope="module")
def walked() -> WalkRun:
    settings = WalkSettings(duration=1.5, bearing=0.3, pushes=PUSHES)
    run = run_walk(settings)
    assert run.outcome is Outcome.COMPLETED
    return run


@pytest.fixture(scope="module")
def folder(walked: WalkRun, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("walks") / "walk"
    assert write_run(place, walked) == place / "walk.png"
    return place


def test_a_walk_is_read_from_its_folder(folder: Path, walked: WalkRun) -> None:
    loaded = load_run(folder, "walk")
    check_same(loaded, walked)
    assert loaded.players == ("walker",) and loaded.robots == ("walker",)
    assert loaded.pair is None and np.isnan(loaded.distance).all()
    assert loaded.theory is None and loaded.safety is None
    assert loaded.settings.pushes == PUSHES
    stage = RunScene(loaded)
    stage.put(40)
    qpos = loaded.walker.qpos
    assert qpos is not None
    np.testing.assert_array_equal(stage.data.qpos, qpos[40])


def test_a_folder_of_another_game_is_refused(
    folder: Path, tmp_path: Path
) -> None:
    with pytest.raises(ConfigurationError, match="a duel, got one of a walk"):
        load_run(folder, "duel")
    duel = run_duel(DuelSettings(duration=0.04))
    write_run_files(tmp_path, duel)
    with pytest.raises(ConfigurationError, match="a walk, got one of a duel"):
        load_run(tmp_path, "walk")


def test_a_walk_can_be_stored_compared_and_replayed(tmp_path: Path) -> None:
    def call(*words: str) -> Any:
        return CliRunner().invoke(main, list(words))

    one, other = str(tmp_path / "one"), str(tmp_path / "other")
    walk = (
        "run",
        "walk",
        "--duration",
        "0.3",
        "--push",
        "0.3@0.1:0",
        "--output",
    )
    told = call(*walk, one, "--json")
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout)["run_folder"] == one
    said = call(*walk, other).stdout
    assert f"{other}/walk.png" in said and f"run folder: {other}" in said
    again = call(
        "run", "walk", "--config", f"{one}/configuration.toml", "--json"
    )
    wanted = json.loads(told.stdout)["push_impulse_n_s"]
    assert json.loads(again.stdout)["push_impulse_n_s"] == wanted
    page = str(tmp_path / "walk.html")
    assert call("show", one, "-o", page).exit_code == 0
    text = Path(page).read_text(encoding="utf-8")
    assert '"distance":null' in text and '"pushed"' in text
    compared = call("show", one, other, "-o", f"{tmp_path}/c.png")
    assert compared.exit_code == 0 and "speed" in compared.stdout
    duel = tmp_path / "duel"
    duel.mkdir()
    write_run_files(duel, run_duel(DuelSettings(duration=0.04)))
    mixed = call("show", one, str(duel), "-o", f"{tmp_path}/d.png")
    assert mixed.exit_code == 2 and mixed.output.count("\n") == 1
    assert "must be of the same game, got duel and walk" in mixed.output
    assert not (tmp_path / "d.png").exists()
    taken = call(*walk, one)
    assert taken.exit_code == 2 and "new or an empty folder" in taken.output
