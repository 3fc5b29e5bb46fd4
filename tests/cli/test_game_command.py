"""Test ``stepaside run FILE``: tables, JSON, run folder and bad input."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main

pytestmark = pytest.mark.usefixtures("blank_figures")

FILE = """
level = "steps"
duration = 3.0

[[players]]
name = "red"
role = "pursuer"

[[players]]
name = "ruby"
role = "pursuer"

[[players]]
name = "blue"
role = "evader"
strategy = "team-evasion"
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "game.toml"
    made.write_text(FILE)
    return made


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(main, ["run", "game", *map(str, arguments)])


def test_json_holds_every_result_and_repeats(file: Path) -> None:
    first, again = (
        json.loads(run(file, "--json", "--level", "unicycle").stdout)
        for _ in range(2)
    )
    assert [*first["players"]] == ["red", "ruby", "blue"]
    assert len(first["pairs"]) == 3
    first.pop("real_time_factor"), again.pop("real_time_factor")
    assert first == again


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (FILE.replace("ruby", "red"), "player names must be unique"),
        (FILE.replace("blue", "Blue"), "lower case"),
        (FILE.replace("evader", "pursuer"), "needs an opponent"),
        (FILE + "wings = 2\n", "unknown entry wings"),
        ("seed = 1", "players must be at least 1"),
        ("players = 3", "players must be tables"),
        ("[[players", "game.toml"),
    ],
)
def test_bad_files_are_refused_in_one_line(
    file: Path, tmp_path: Path, text: str, message: str
) -> None:
    file.write_text(text)
    done = run(file, "--output", tmp_path / "out")
    assert done.exit_code == 2
    (line,) = done.stderr.strip().splitlines()
    assert message in line
    assert not (tmp_path / "out").exists()


def test_games_are_compared_and_have_no_robot_models_without_robots(
    file: Path, tmp_path: Path
) -> None:
    folders = []
    for seed in ("1", "2"):
        folders.append(tmp_path / seed)
        run(file, "--seed", seed, "--output", folders[-1])
    figure = tmp_path / "both.png"
    done = CliRunner().invoke(
        main, ["show", *map(str, folders), "-o", str(figure)]
    )
    assert done.exit_code == 0, done.output
    assert "closest" in done.output and figure.is_file()
    models = ["show", str(folders[0]), "-o", f"{folders[0]}.urdf"]
    refused = CliRunner().invoke(main, models)
    assert refused.exit_code != 0
    assert "urdf needs a run with a robot" in refused.output
