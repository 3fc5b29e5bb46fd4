"""Printed tables: labels with units, never raw keys; progress lines."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any, BinaryIO

import pytest
from click.testing import CliRunner, Result
from matplotlib.figure import Figure

from stepaside.cli.main import main
from stepaside.core import progress
from stepaside.games import game
from stepaside.report.result_labels import LABELS, UNITS, in_unit, label_of

from drawn_figure import content_of  # isort: skip
from flows.calls import EXAMPLES  # isort: skip
from stored_values import (  # isort: skip
    DATA,
    PATH,
    compare_stored,
    summed,
    words_of,
)

pytestmark = pytest.mark.usefixtures("blank_figures", "inline_workers")

DUEL = "duel --duration 1"
COMMANDS = tomllib.loads((DATA / "commands.toml").read_text("utf-8"))
# Commands that show their progress.
LONG = ("duel", "walk", "circle", "map", "bound")
TIMED = ("seconds_s", "real_time_factor", "median_us", "p99_us", "bytes")


def shown_by(words: str, status: int = 0) -> Result:
    """Run a command; its progress is a line at each update."""
    shown = CliRunner().invoke(main, words.split())
    assert shown.exit_code == status, shown.output
    command = words.removeprefix("run ").removeprefix("theory ").split()[0]
    lines = [
        line
        for line in shown.stderr.splitlines()
        if line.startswith(f"stepaside: {command}: ")
    ]
    if command in LONG and not status:
        assert lines and all("s so far" in line for line in lines)
        assert "%" in lines[-1] and "\r" not in shown.output
        assert "so far" not in shown.stdout
    return shown


@pytest.fixture
def progress_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(progress, "PERIOD", 0.0)
    monkeypatch.setattr(game, "REPORT_PERIOD", 0.0)


def timeless(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a JSON object without times and folders of the machine."""
    return {
        name: value
        for name, value in pairs
        if name not in TIMED and not f"{value}".startswith("/")
    }


@pytest.mark.parametrize("words", COMMANDS["printed"])
def test_a_command_prints_and_draws_what_is_stored(
    words: str, progress_lines: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Store what is meant: STORE=1 pytest tests/cli/test_tables.py.

    Commands follow each other in a folder; one after "!" refuses.
    """
    figures: list[Figure] = []

    def save(figure: Figure, file: BinaryIO, **_: Any) -> None:
        figures.append(figure)
        file.write(b"figure")

    monkeypatch.setattr(Figure, "savefig", save)
    found: list[str | float] = []
    for command in words.replace("EXAMPLES", str(EXAMPLES)).split(" ; "):
        command = command.replace("FIGURE", "figure.png")
        shown = shown_by(command.lstrip("!"), 2 * command.startswith("!"))
        if command.endswith("--json"):
            read = json.loads(shown.stdout, object_pairs_hook=timeless)
            for name, value in read.items():
                found += [name, *summed(value)]
        else:
            table = re.sub(rf"{PATH}|\(\S+ MB\)", "", shown.stdout)
            assert not re.findall(r"\b[a-z]{2,}_\w+", table), shown.stdout
            assert not re.findall(r"\b(?:True|False|None)\b", table), table
            found += words_of(table)
        for line in shown.stderr.splitlines():
            new = "compiling" not in line and "so far" not in line
            found += [re.sub(PATH, "", line)] if new else []
        shares = re.findall(r"(\d+) %", shown.stderr)
        found += shares[-1:] if "duration" in command else []
    for figure in figures:
        found += content_of(figure)
    found += sorted(str(f) for f in Path().rglob("*") if f.suffix)
    compare_stored("commands.json", words, found)


def test_labels_and_units_are_those_that_are_stored() -> None:
    names = [*(f"some{end}" for end in UNITS), *LABELS]
    found = [f"{label_of(n, unit=True)} {in_unit(n, 0.5):g}" for n in names]
    compare_stored("commands.json", "labels", found)


@pytest.mark.parametrize("words", ["run walk --duration 9", DUEL])
def test_progress_is_not_among_json(words: str, progress_lines: None) -> None:
    assert shown_by(f"{words} --json").stdout.startswith("{")


def test_the_page_of_installation_names_every_extra() -> None:
    root = Path(__file__).parents[2]
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    page = (root / "docs/installation.md").read_text()
    for extra, needs in project["optional-dependencies"].items():
        (row,) = re.findall(rf"(?m)^\| `{extra}` \|.*$", page)
        for need in needs:
            name = re.split(r"[><=;\[ ]", need)[0]
            assert name in row or "everything" in row, (extra, name)
