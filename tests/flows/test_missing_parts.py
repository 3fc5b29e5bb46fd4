"""What a bare installation does, and what it says is missing."""

import json
import re
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from flows import calls

SCRIPT = Path(__file__).parents[1] / "without_extras.py"
PROJECT = calls.EXAMPLES.parent / "pyproject.toml"
SHORT = "--duration 0.02 --json"
WORKS = (
    f"duel {SHORT} --output run",
    "show run -o run.png",
    "show run -o run.csv",
    "show run -o run.urdf",
    f"run walk {SHORT}",
    "theory plan --role evader --bearing 0.1 --json",
    "run unicycles --duration 1 --json",
    "theory circle --starts 2 --json",
    "theory map --grid 2 --set distances=1 --set duration=1 --json",
    "theory bound --grid 16 --json",
    "robot --json",
    "doctor --json",
)
NEEDS = {
    f"duel {SHORT} --sensing cameras": "vision",
    f"duel {SHORT} --set control.method=mpc": "mpc",
    "view --no-open": "viewer",
    "show run --no-open": "viewer",
    "show run -o page.html": "viewer",
    "show run -o run.mcap": "export",
    "show run -o run.parquet": "export",
    "show run -o film.mp4": "viewer",
    "play lola:none --role evader": "robot",
    "serve --ros2 evader=/e --wait 0.1": "robot",
}
PACKAGES = {  # modules, where a package has another name
    "opencv-python-headless": "cv2",
    "dask-jobqueue": "dask_jobqueue",
    "pyyaml": "yaml",
}


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Status, errors and output of each line, where no extra is."""
    helps = [f"{name} --help" for name in calls.commands()]
    lines = [*WORKS, *NEEDS, *helps]
    done = subprocess.run(
        [sys.executable, str(SCRIPT), json.dumps(lines)],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path_factory.mktemp("bare"),
    )
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    return {line: rest for line, *rest in rows}


def modules_of_extras() -> dict[str, set[str]]:
    """Modules of each extra for users, by the metadata of the package."""
    project = tomllib.loads(PROJECT.read_text())["project"]
    found = {
        name: {re.split(r"[\[><=!~; ]", package)[0] for package in packages}
        for name, packages in project["optional-dependencies"].items()
        if name not in ("all", "bench", "dev", "docs")
    }
    return {
        name: {PACKAGES.get(package, package) for package in packages}
        for name, packages in found.items()
    }


@pytest.mark.parametrize("line", WORKS)
def test_a_basic_command_works_without_extras(
    bare: dict[str, Any], line: str
) -> None:
    assert bare[line][0] == 0, bare[line]


@pytest.mark.parametrize("line", NEEDS)
def test_a_missing_extra_is_named_in_one_line(
    bare: dict[str, Any], line: str
) -> None:
    status, said, _ = bare[line]
    assert status == 2, said
    assert f"pip install 'stepaside[{NEEDS[line]}]'" in said
    assert said.count("\n") == 1


def test_every_command_has_help_without_extras(bare: dict[str, Any]) -> None:
    helps = [line for line in bare if line.endswith(" --help")]
    assert len(helps) >= 11
    assert [bare[line][0] for line in helps] == [0] * len(helps)


def test_doctor_finds_that_no_extra_is_there(bare: dict[str, Any]) -> None:
    found = json.loads(bare["doctor --json"][2])
    assert found["missing"] == []
    told = {
        name: set(extra["missing_modules"])
        for name, extra in found["extras"].items()
    }
    assert told == modules_of_extras()


def test_doctor_tells_what_is_installed() -> None:
    found = calls.stepaside("doctor", "--json").json
    assert found["python"] == ".".join(map(str, sys.version_info[:3]))
    assert {"mujoco", "numpy", "scipy", "click"} <= set(found["libraries"])
    for name, modules in modules_of_extras().items():
        missing = {module for module in modules if find_spec(module) is None}
        told = found["extras"][name]
        assert set(told["missing_modules"]) == missing
        assert told["installed"] == (not missing)
