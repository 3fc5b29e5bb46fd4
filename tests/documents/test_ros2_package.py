"""Test the ament package: its files, and the command that it launches."""

import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import pytest

from stepaside.cli.play import play
from tools.documents.store import ROOT

PACKAGE = ROOT / "examples" / "ros2" / "stepaside_bringup"


class Action:
    """Stands for an action or a substitution of launch."""

    def __init__(self, *values: Any, **named: Any) -> None:
        self.values, self.named = values, named


class Declared(Action):
    """Stands for a launch argument."""


class Process(Action):
    """Stands for a process."""


class Description(Action):
    """Stands for a launch description."""


@pytest.fixture
def description(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Launch description, made with stand-ins for launch."""
    pytest.importorskip("yaml", reason="PyYAML is not installed")
    parts: dict[str, dict[str, Any]] = {
        "launch": {"LaunchDescription": Description},
        "launch.actions": {
            "DeclareLaunchArgument": Declared,
            "ExecuteProcess": Process,
        },
        "launch.conditions": {
            "IfCondition": Action,
            "UnlessCondition": Action,
        },
        "launch.substitutions": {"LaunchConfiguration": Action},
    }
    for name, content in parts.items():
        module = ModuleType(name)
        for key, value in content.items():
            setattr(module, key, value)
        monkeypatch.setitem(sys.modules, name, module)
    file = PACKAGE / "launch" / "player.launch.py"
    return runpy.run_path(str(file))["generate_launch_description"]()


def test_play_accepts_what_is_launched(description: Any) -> None:
    declared = {
        action.values[0]: action.named["default_value"]
        for action in description.values[0]
        if isinstance(action, Declared)
    }
    processes = [a for a in description.values[0] if isinstance(a, Process)]
    assert len(processes) == 2
    for process in processes:
        words = [
            "".join(
                declared[part.values[0]] if isinstance(part, Action) else part
                for part in (word if isinstance(word, list) else [word])
            )
            for word in process.named["cmd"]
        ]
        assert words[:2] == ["stepaside", "play"]
        context = play.make_context("play", words[2:])
        assert context.params["address"] == declared["address"]
        assert f"role={declared['role']}" in context.params["sets"]
    assert declared["address"].startswith("ros2:/")


def test_every_file_that_setup_installs_exists(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    given: dict[str, Any] = {}
    module = ModuleType("setuptools")
    monkeypatch.setitem(sys.modules, "setuptools", module)
    module.__dict__["setup"] = lambda **named: given.update(named)
    runpy.run_path(str(PACKAGE / "setup.py"))
    for _, files in given["data_files"]:
        for file in files:
            assert (PACKAGE / file).is_file()
    manifest = ElementTree.parse(PACKAGE / "package.xml").getroot()
    assert manifest.findtext("name") == given["name"] == PACKAGE.name
    assert manifest.findtext("version") == given["version"]
    assert (PACKAGE / Path(given["packages"][0])).is_dir()


def test_colcon_builds_it(tmp_path: Path) -> None:
    """``make test-ament`` has colcon."""
    colcon = shutil.which("colcon")
    if colcon is None:
        pytest.skip("colcon is not installed")
    shutil.copytree(PACKAGE, tmp_path / "src" / PACKAGE.name)
    done = subprocess.run(
        [colcon, "build"], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    share = tmp_path / "install" / PACKAGE.name / "share"
    index = share / "ament_index" / "resource_index" / "packages"
    assert (index / PACKAGE.name).is_file()
    for file in ("launch/player.launch.py", "config/player.yaml"):
        installed = share / PACKAGE.name / file
        assert installed.read_bytes() == (PACKAGE / file).read_bytes()
    assert (tmp_path / "install" / "setup.bash").is_file()
