"""Test what strategies, models and records of others must not do to us."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.robots.description import load_robot

STRATEGY = """
import os, sys
from stepaside import Direction, Intent
{top}
class Own:
    direction = Direction.BACKWARD
    saturated = False
    def __init__(self):
        {made}
    def begin(self):
        {begin}
        return 0
    def decide(self, knowledge, memory):
        {decide}
        return Intent(0.4), memory + 1
"""
PLACES = ("top", "made", "begin", "decide")
EXITS = ("sys.exit(0)", "sys.exit()", "exit('bye')", "raise SystemExit(3)")


def strategy(folder: Path, **code: str) -> str:
    """Name of a strategy that runs some code in some places."""
    file = folder / "own.py"
    file.write_text(STRATEGY.format(**(dict.fromkeys(PLACES, "pass") | code)))
    return f"{file}:Own"


def command(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "stepaside", *words],
        capture_output=True,
        text=True,
        timeout=300,
    )


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("code", EXITS)
def test_a_strategy_that_exits_is_refused_with_its_name(
    tmp_path: Path, place: str, code: str
) -> None:
    name = strategy(tmp_path, **{place: code})
    words = ("duel", "--duration", "1", "--strategy", name)
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2
    assert "SystemExit" in result.output and "own.py" in result.output


LATE = "{} if knowledge.time > 2.6 else None"


@pytest.mark.parametrize("level", ["steps", "physics"])
@pytest.mark.parametrize("code", ["sys.exit(0)", "1 / 0"])
def test_a_strategy_that_fails_later_ends_its_game_in_words(
    tmp_path: Path, code: str, level: str
) -> None:
    name = strategy(tmp_path, decide=LATE.format(code))
    reason = "SystemExit" if "exit" in code else "ZeroDivision"
    words = f"duel --json --duration 4 --set level={level} --strategy {name}"
    done = CliRunner().invoke(main, words.split())
    found = json.loads(done.stdout)
    assert found["outcome"] == "failed" and done.exit_code == 1
    assert "evader's strategy failed" in found["message"]
    assert reason in found["message"] and "(own.py, line 14)" in done.stdout


PRINTS = (
    "print('noise0')",
    "sys.stdout.write('noise1')",
    "sys.__stdout__.write('noise2')",
    "os.write(1, b'noise3')",
    "os.system('echo noise4')",
)


def test_what_a_strategy_prints_is_not_among_json(tmp_path: Path) -> None:
    code = "; ".join(PRINTS)
    name = strategy(tmp_path, **dict.fromkeys(PLACES, code))
    found = command(
        *("duel", "--set", "level=steps", "--duration", "0.1", "--json"),
        *("--strategy", name),
    )
    assert found.returncode == 0, found.stderr
    assert json.loads(found.stdout)["outcome"] == "completed"
    assert found.stdout.count("\n") == 1
    for kind, _ in enumerate(PRINTS):
        assert f"noise{kind}" in found.stderr


@pytest.mark.slow
def test_what_workers_print_is_not_among_json(tmp_path: Path) -> None:
    name = strategy(tmp_path, decide="print('noise', flush=True)")
    words = ["study", "tournament", "--workers", "2", "--json"]
    for change in (f"evader={name}", "seed=1:3", "duration=1"):
        words += ["--set", change]
    found = command(*words)
    assert found.returncode == 0, found.stderr
    assert json.loads(found.stdout)
    assert "noise" in found.stderr


def test_json_goes_out_where_standard_error_is_closed(tmp_path: Path) -> None:
    name = strategy(tmp_path, decide="print('noise')")
    line = [sys.executable, "-m", "stepaside", "duel", "--json", "--set"]
    line += ["level=steps", "--duration", "0.1", "--strategy", name]
    found = subprocess.run(
        ["sh", "-c", '"$@" 2>&-', "sh", *line],
        stdout=subprocess.PIPE,
        text=True,
        timeout=100,
    )
    assert json.loads(found.stdout)["outcome"] == "completed"


MODELS = (
    "<mujoco/>",
    "<mujoco><worldbody/></mujoco>",
    '<mujoco><worldbody><body name="other"/></worldbody></mujoco>',
    '<mujoco><worldbody><body name="torso"/></worldbody></mujoco>',
    "",
    "<robot/>",
)


DUEL = ("duel", "--duration", "1", "--json")


@pytest.mark.parametrize(
    ("model", "words"),
    [
        *((model, (*DUEL, "--robot")) for model in MODELS),
        (MODELS[1], ("walk", "--duration", "1", "--json", "--robot")),
        (MODELS[1], ("robot",)),
        (MODELS[1], (*DUEL, "--set", "evader.robot=")),
    ],
)
def test_a_model_without_the_robot_is_refused(
    tmp_path: Path, model: str, words: tuple[str, ...]
) -> None:
    folder = tmp_path / "robot"
    shutil.copytree(load_robot("nao").folder, folder)
    (folder / "tree.json").unlink()
    (folder / "model.xml").write_text(model)
    if words[-1].endswith("="):
        words = (*words[:-1], f"{words[-1]}{folder}")
    else:
        words = (*words, str(folder))
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2, result.output
    assert result.output.startswith("stepaside: ")
