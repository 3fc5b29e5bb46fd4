"""Test ``stepaside robot legs``."""

import json
from pathlib import Path

import pytest

pytest.importorskip("onnxruntime")

from small_policies import constant_policy
from stepaside.cli.main import main


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
