"""Test ``stepaside legs``."""

import json
from pathlib import Path

import pytest

pytest.importorskip("onnxruntime")

import numpy as np

from small_policies import constant_policy
from stepaside.cli.main import main
from torchscript_archives import Module, write_archive


def test_inspect_prints_the_contract_with_its_sources(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = constant_policy(tmp_path / "a.onnx", default_joint_pos=[0.1] * 3)
    with pytest.raises(SystemExit) as left:
        main(["legs", "inspect", str(path), "--json"])
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
        (["--legs-contract", "none"], "must be one of holosoma"),
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
        main(["legs", "inspect", str(path), *options])
    assert left.value.code == 2
    error = capsys.readouterr().err
    assert words in error and error.count("\n") == 1


LAYER = {
    "__torch__.net": "class Network(Module):\n"
    "  def forward(self: __torch__.net.Network, x: Tensor) -> Tensor:\n"
    "    return torch.linear(x, self.weight)\n"
}


def test_convert_writes_a_network_with_its_contract(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("onnx")
    root = Module(
        "__torch__.net.Network", {"weight": np.eye(3, 20, dtype=np.float32)}
    )
    archive = write_archive(tmp_path / "motion.pt", root, LAYER)
    arguments = ["legs", "convert", str(archive)]
    named = ["--legs-contract", "legged_gym", "--json"]
    assert exit_status([*arguments, *named]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["input"] == "obs [1, 20]"
    assert facts["file"] == str(tmp_path / "motion.onnx")
    assert exit_status(["legs", "inspect", facts["file"], "--json"]) == 2
    facts = json.loads(capsys.readouterr().out)
    assert facts["convention"] == "legged_gym"
    assert exit_status(arguments) == 2
    assert "--overwrite replaces it" in capsys.readouterr().err


def test_convert_writes_nothing_of_what_it_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("onnx")
    archive = tmp_path / "motion.pt"
    archive.write_bytes(b"text")
    assert exit_status(["legs", "convert", str(archive)]) == 2
    error = capsys.readouterr().err
    assert "is not a TorchScript archive" in error and error.count("\n") == 1
    assert list(tmp_path.iterdir()) == [archive]


def exit_status(arguments: list[str]) -> int:
    with pytest.raises(SystemExit) as left:
        main(arguments)
    return int(left.value.code or 0)
