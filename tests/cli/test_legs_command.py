"""Test ``stepaside robot legs``."""

import json
import shutil
from pathlib import Path

import pytest

pytest.importorskip("onnxruntime")

from small_policies import constant_policy
from stepaside import load_robot
from stepaside.cli.main import main
from stepaside.fitting.legs_measurement import LegsMeasurement, LegsTrialResult
from stepaside.locomotion.policy.velocity_response import (
    AxisResponse,
    VelocityResponse,
)
from stepaside.strategies.velocity_set import BodyVelocity


def test_inspect_prints_the_contract_with_its_sources(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = constant_policy(tmp_path / "a.onnx", default_joint_pos=[0.1] * 3)
    with pytest.raises(SystemExit) as left:
        main(["robot", "legs", "inspect", str(path), "--json"])
    assert left.value.code == 2  # holosoma names no posture of these joints
    facts = json.loads(capsys.readouterr().out)
    assert facts["convention"] == "holosoma"
    assert facts["sources"]["stiffness"] == "metadata kp"
    assert facts["contract"]["stiffness"] == [40.0, 50.0, 20.0]
    assert facts["findings"][0] == {
        "severity": "error",
        "text": "default_posture is missing",
    }


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--legs-contract", "none"], "must be one of bhuman"),
        (["--robot", "nao"], "default_posture is missing"),
    ],
)
def test_inspect_refuses_in_one_line(
    options: list[str],
    words: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = constant_policy(tmp_path / "a.onnx")
    with pytest.raises(SystemExit) as left:
        main(["robot", "legs", "inspect", str(path), *options])
    assert left.value.code == 2
    error = capsys.readouterr().err
    assert words in error and error.count("\n") == 1


def test_measure_prints_a_row_for_each_command(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    slow, still = BodyVelocity(forward=0.4), BodyVelocity()
    nan = float("nan")
    fallen = BodyVelocity(nan, nan, nan)
    moves = slow, BodyVelocity(lateral=0.4), BodyVelocity(turn=0.4)
    forward, lateral, turn = (
        AxisResponse((0.0, 0.5), (still, move)) for move in moves
    )
    found = LegsMeasurement(
        [
            LegsTrialResult(BodyVelocity(0.5), slow, 0.2, 0.1, None),
            LegsTrialResult(BodyVelocity(-0.5), fallen, nan, nan, 1.5),
        ],
        VelocityResponse(forward, lateral, turn),
        1,
    )
    monkeypatch.setattr(
        "stepaside.fitting.legs_measurement.measure_legs",
        lambda *_, **__: found,
    )
    robot = shutil.copytree(load_robot("nao").folder, tmp_path / "nao")
    network = constant_policy(tmp_path / "a.onnx")
    with pytest.raises(SystemExit) as left:
        main(["robot", "legs", "measure", str(robot), "--legs", str(network)])
    assert not left.value.code
    rows = capsys.readouterr().out.splitlines()
    assert rows[1].split() == [
        "0.500",
        "0.000",
        "0.000",
        "0.400",
        "0.000",
        "0.000",
        "-",
    ]
    assert rows[2].split() == [
        "-0.500",
        "0.000",
        "0.000",
        "-",
        "-",
        "-",
        "1.500",
    ]
