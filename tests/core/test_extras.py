"""Test that a missing optional dependency is named with its remedy."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from stepaside.cli.main import all_commands
from stepaside.core.extras import EXTRAS, install_hint
from tools.documents.store import ROOT

PACKAGES = {  # where the name of the package differs
    "cv2": "opencv-python-headless",
    "dask_jobqueue": "dask-jobqueue",
    "yaml": "pyyaml",
}
SHORT = "--duration 0.02 --json"
WORKS = (
    f"duel {SHORT} --output run",
    "compare run",
    "export run --to csv",
    "export run --to urdf",
    f"walk {SHORT}",
    "plan --role evader --bearing 0.1 --json",
    "unicycles --duration 1 --json",
    "circle --starts 2 --json",
    "map --grid 2 --distances 1 --duration 1 --json",
    "bound --grid 16 --refine 0 --games 0 --horizon 0.01 --json",
    "robot --json",
)
NEEDS = {
    f"duel {SHORT} --sensing cameras": "vision",
    f"duel {SHORT} --method mpc": "mpc",
    "view --no-open --serve-for 0.1": "viewer",
    "replay run --no-open": "viewer",
    "replay run --html page.html": "viewer",
    "export run --to mcap": "export",
    "export run --to parquet": "tables",
    "replay run --video film.mp4": "viewer",
    "play --role evader --robot lola:none": "robot",
    "serve --lola evader=socket --wait 0.1": "robot",
}


@pytest.fixture(scope="module")
def results(
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, list[object]]:
    helps = [f"{name} --help" for name in all_commands()]
    lines = [*WORKS, *NEEDS, *helps]
    script = Path(__file__).parents[1] / "without_extras.py"
    done = subprocess.run(
        [sys.executable, str(script), json.dumps(lines)],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path_factory.mktemp("without"),
    )
    rows = [json.loads(line) for line in done.stdout.splitlines()]
    return {line: [status, text] for line, status, text in rows}


@pytest.mark.parametrize("line", WORKS)
def test_a_basic_command_works_without_extras(
    results: dict[str, list[object]], line: str
) -> None:
    assert results[line][0] == 0, results[line]


@pytest.mark.parametrize("line", NEEDS)
def test_a_missing_extra_is_named_in_one_line(
    results: dict[str, list[object]], line: str
) -> None:
    status, text = results[line]
    assert status == 2 and isinstance(text, str), text
    assert f"pip install 'stepaside[{NEEDS[line]}]'" in text
    assert text.count("\n") == 1


def test_every_command_has_help_without_extras(
    results: dict[str, list[object]],
) -> None:
    for name in all_commands():
        assert results[f"{name} --help"][0] == 0, name


def test_the_table_matches_the_package_metadata() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    extras = tomllib.loads(text)["project"]["optional-dependencies"]
    for name, modules in EXTRAS.items():
        wanted = {PACKAGES.get(module, module) for module in modules}
        assert wanted == {re.split(r"[><=!]", e)[0] for e in extras[name]}
    others = set(extras) - set(EXTRAS)
    assert others == {"all", "bench", "dev", "docs"}


def test_a_missing_core_dependency_names_the_package() -> None:
    error = ModuleNotFoundError("No module named 'click.x'", name="click.x")
    assert install_hint(error).endswith(
        "click, which is not installed: pip install stepaside"
    )
