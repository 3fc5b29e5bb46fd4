"""Test that run folders are read as written."""

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array
from stepaside.games.game import Outcome
from stepaside.games.game_settings import StartSettings, read_game
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.run_archive import (
    SUMMARY,
    TRAJECTORIES,
    load_run,
    write_run_files,
)
from stepaside.games.settings_reader import load_game
from stepaside.games.trajectory import Trajectory
from stepaside.report.export.recording import repeat_game
from stepaside.report.run_folder import write_run
from stepaside.report.scene import RunScene
from stepaside.robots.description import load_robot
from synthetic_run import check_same, run_of

ROWS = 6
TIMES: Array = 0.02 * np.arange(float(ROWS))


def robot(number: float, *, sees: bool = False) -> Trajectory:
    """Return a robot whose values identify each quantity."""
    rows = np.arange(float(ROWS))[:, None]

    def table(base: float, columns: int) -> Array:
        made: Array = 100.0 * number + base + rows + 0.1 * np.arange(columns)
        return made

    zmp = table(5.0, 2)
    zmp[2] = np.nan  # in flight
    return Trajectory(
        com=table(1.0, 3),
        torso=table(2.0, 3),
        com_reference=table(3.0, 2),
        zmp_reference=table(4.0, 2),
        zmp=zmp,
        qpos=table(6.0, 30).astype(np.float32),
        landings=table(7.0, 5)[:2],
        sight=table(8.0, 6) if sees else None,
    )


def person() -> Trajectory:
    track = robot(1.0)
    return Trajectory(track.com, track.torso)


def duel(pursuer: Trajectory, **changes: Any) -> Run:
    return run_of(
        TIMES,
        {"pursuer": pursuer, "evader": robot(2.0, sees=True)},
        settings=make_duel(
            seed=9, start=StartSettings(1.3, 0.4, -0.2)
        ).resolved(),
        name="run",
        **changes,
    )


RUNS = {
    "robots": duel(robot(1.0)),
    "seeing robots": duel(robot(1.0, sees=True)),
    "a person": duel(person()),
    "all stood": duel(
        replace(robot(1.0), landings=np.zeros((0, 5))),
        outcome=Outcome.UNREACHABLE,
        message="pursuer lost its footing at 0.10 s: too far",
    ),
}
by_run = pytest.mark.parametrize("run", RUNS.values(), ids=RUNS.keys())


def folder_of(tmp_path: Path, run: Run) -> Path:
    folder = tmp_path / "run"
    folder.mkdir()
    write_run_files(folder, run)
    return folder


def damage(folder: Path, change: Callable[[dict[str, Any]], Any]) -> None:
    """Change the summary of a folder."""
    plain = json.loads((folder / SUMMARY).read_text())
    change(plain)
    (folder / SUMMARY).write_text(json.dumps(plain))


@by_run
def test_a_run_is_read_as_written(tmp_path: Path, run: Run) -> None:
    check_same(load_run(folder_of(tmp_path, run)), run)


def test_a_network_keeps_its_name_and_its_weights(tmp_path: Path) -> None:
    """The measured response of legs is found by the name."""
    network, weights = tmp_path / "net.onnx", tmp_path / "net.onnx.data"
    network.touch()
    weights.touch()
    run = RUNS["robots"]
    settings = run.settings.changed(legs={"network": str(network)})
    folder = folder_of(tmp_path, replace(run, settings=settings))
    kept = Path(load_run(folder).settings.pursuer.legs.network)
    assert kept.name == "net.onnx" and kept.is_relative_to(folder)
    assert kept.with_name("net.onnx.data").is_file()


@pytest.mark.parametrize("number", [4, 6, 0, -1, 5.0, "5", True, None, [5]])
def test_an_unknown_format_is_refused_by_its_number(
    tmp_path: Path, number: Any
) -> None:
    """Before anything else is read."""
    folder = folder_of(tmp_path, RUNS["robots"])

    def renumber(plain: dict[str, Any]) -> None:
        plain.clear()
        plain["format"] = number

    damage(folder, renumber)
    with pytest.raises(ConfigurationError) as refused:
        load_run(folder)
    message = str(refused.value)
    assert f"run must be 5, got {number!r}" in message
    assert "\n" not in message


def test_a_changed_byte_is_refused_or_harmless(tmp_path: Path) -> None:
    """It never changes values that are read, nor raises other errors."""
    run = RUNS["robots"]
    folder = folder_of(tmp_path, run)
    whole = (folder / TRAJECTORIES).read_bytes()
    generator = np.random.default_rng(1)
    refused = 0
    for at in generator.integers(len(whole), size=150):
        spoilt = bytearray(whole)
        spoilt[at] ^= 1 << int(generator.integers(8))
        (folder / TRAJECTORIES).write_bytes(spoilt)
        try:
            check_same(load_run(folder), run)
        except ConfigurationError:
            refused += 1
    assert refused > 100


def test_naos_gaits_are_not_those_of_a_robot_with_its_own(
    tmp_path: Path,
) -> None:
    own = shutil.copytree(load_robot("nao").folder, tmp_path / "mine")
    file = own / "robot.toml"
    text = file.read_text("utf-8")
    file.write_text(text.replace("\nstride = 0.04", "\nstride = 0.03"))
    with pytest.raises(ConfigurationError, match="has its own"):
        read_game({"robot": str(own), "gait": "fast"}, base=make_duel())


def test_a_run_of_an_own_robot_opens_where_it_is_carried(
    tmp_path: Path,
) -> None:
    """Its description is in the folder; the original may be gone."""
    own = tmp_path / "mine"
    shutil.copytree(load_robot("nao").folder, own)
    short = make_duel(duration=0.2)
    run = run_game(read_game({"robot": str(own)}, base=short))
    folder = write_run(tmp_path / "run", run, drawn=False).parent
    shutil.rmtree(own)
    carried = load_run(folder.rename(tmp_path / "elsewhere"), "duel")
    assert Path(carried.settings.evader.robot).is_relative_to(
        tmp_path / "elsewhere"
    )
    RunScene(carried)
    again, reason = repeat_game(carried)
    assert not reason and again.evader.joint_effort is not None
    path = tmp_path / "elsewhere" / "configuration.toml"
    assert load_game(path) == carried.settings
