"""Printed tables: labels with units, never raw keys; progress lines."""

import re
from pathlib import Path
from typing import Any, BinaryIO

import pytest
from click.testing import CliRunner, Result
from matplotlib.figure import Figure

from stepaside.cli.main import main
from stepaside.core import progress
from stepaside.games import game

from drawn_figure import content_of  # isort: skip
from flows.calls import EXAMPLES  # isort: skip
from stored_values import compare_stored, words_of  # isort: skip

pytestmark = pytest.mark.usefixtures("blank_figures", "inline_workers")

DUEL = "duel --duration 1"
FAST = (
    "--set pursuer_speed=2 --set evader_speed=1 --set pursuer_gain=1 "
    "--set evader_gain=4"
)
TABLES = [
    f"{DUEL} --set level=steps --set pursuer.strategy=lead --distance 0.7",
    "run walk --duration 4 --push 0.2@1.5:90deg",
    "theory plan --role evader --bearing 0.3 --figure FIGURE",
    "theory plan --role pursuer --bearing 1.2 --gait fast --figure FIGURE",
    "run unicycles --speed 0.1 --gain 0.2 --figure FIGURE",
    "theory circle --speed 0.1 --gain 0.2 --starts 2 --figure FIGURE",
    "theory circle --set evader_gain=0.3 --set sample_time=0.1 --starts 1",
    "theory circle --angle 0",
    "theory circle --speed 1 --gain 0.5 --set sample_time=0.4 --set delay=0.2",
    "theory circle --set delay=5 --starts 1",
    f"theory circle {FAST} --set side_rule=latched --starts 1",
    "run unicycles --speed 1 --gain 1 --distance 1.57 --aim 0.31 "
    "--bearing=-1.05",
    "run unicycles --speed 1 --gain 1 --distance 1.57 --aim 0.31 "
    "--bearing 2.5 --law saturated --angle 0.3",
    f"theory map {FAST} --grid 3 --set distances=1 --figure FIGURE",
    "theory map --grid 3 --set distances=2 --set duration=5 --figure FIGURE",
    "theory bound --grid 16 --set horizon=0.1 --figure FIGURE",
    "theory bound --grid 16 --set horizon=0.1 --against any",
    "theory bound --against person --evader-speed 0.6 --grid 16 "
    "--figure FIGURE",
    "study tournament --set seed=0:3 --set duration=16.41 --set "
    "evader=evasion,matador --set pursuer=pursuit --by evader --value "
    "survived --value closest_m --workers 1 --figure FIGURE",
    "study EXAMPLES/teams.toml --set pursuers=pursuit,pincer --set seed=0:3 "
    "--set duration=9 --workers 1 --figure FIGURE",
    "study duels --set seed=1:3 --set level=steps --set duration=40 --set "
    "evader.evasion.angle=1.2 --value over_certificate_m --value on_circle "
    "--value triggered_at_distance_m --by seed --workers 1",
    "study people --set speed=0.6 --set bearing=0 --set seed=1 --set "
    "person=scared --workers 1",
    "run EXAMPLES/two-pursuers.toml --set level=steps --set duration=9",
    "run EXAMPLES/crowd.toml --set level=steps --set duration=5",
    "run room --discs 2 --doors 1 --figure FIGURE",
    "run EXAMPLES/teams.toml --set level=steps --duration 9",
    "robot nao",
]
# Commands that show their progress.
LONG = ("duel", "walk", "circle", "map", "bound")


def shown_by(words: str) -> Result:
    """Run a command; its progress is a line at each update."""
    shown = CliRunner().invoke(main, words.split())
    assert shown.exit_code == 0, shown.output
    command = words.removeprefix("run ").removeprefix("theory ").split()[0]
    lines = [
        line
        for line in shown.stderr.splitlines()
        if line.startswith(f"stepaside: {command}: ")
    ]
    if command in LONG:
        assert lines and all("s so far" in line for line in lines)
        assert "%" in lines[-1] and "\r" not in shown.output
        assert "so far" not in shown.stdout
    return shown


@pytest.fixture
def progress_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(progress, "PERIOD", 0.0)
    monkeypatch.setattr(game, "REPORT_PERIOD", 0.0)


@pytest.mark.parametrize("words", TABLES)
def test_a_command_prints_and_draws_what_is_stored(
    words: str, progress_lines: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Store what is meant: STORE=1 pytest tests/cli/test_tables.py."""
    figures: list[Figure] = []

    def save(figure: Figure, file: BinaryIO, **_: Any) -> None:
        figures.append(figure)
        file.write(b"figure")

    monkeypatch.setattr(Figure, "savefig", save)
    command = words.replace("EXAMPLES", str(EXAMPLES))
    shown = shown_by(command.replace("FIGURE", "figure.png"))
    table = re.sub(r"\S*/\S*", "", shown.stdout)
    assert not re.findall(r"\b[a-z]{2,}_\w+", table), shown.stdout
    assert not re.findall(r"\b(?:True|False|None)\b", table), shown.stdout
    found = [*words_of(table)]
    for figure in figures:
        found += content_of(figure)
    compare_stored("commands.json", words, found)


@pytest.mark.parametrize("words", ["run walk --duration 9", DUEL])
def test_progress_is_not_among_json(words: str, progress_lines: None) -> None:
    assert shown_by(f"{words} --json").stdout.startswith("{")


def test_the_page_of_installation_names_every_extra() -> None:
    import tomllib

    root = Path(__file__).parents[2]
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    page = (root / "docs/installation.md").read_text()
    for extra, needs in project["optional-dependencies"].items():
        (row,) = re.findall(rf"(?m)^\| `{extra}` \|.*$", page)
        for need in needs:
            name = re.split(r"[><=;\[ ]", need)[0]
            assert name in row or "everything" in row, (extra, name)
