"""Every tutorial runs, with short games."""

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from flows import calls

TUTORIALS = sorted((calls.EXAMPLES.parent / "docs" / "tutorials").glob("*.py"))
SHELL = {"&", "|", ">", "<", ";", "&&", "wait"}
SECONDS = 1  # of a game, at most
SHORTER = {  # what takes long otherwise; another flow checks a robot
    "own_humanoid": {"robot check humanoid --figure": "robot humanoid >"},
    "people": {"0.4 0.7 1.0 1.3": "1.0", "0.4, 0.7, 1.0, 1.3": "1.0,"},
    "study": {"number = 7": "number = 2", "duration = 120": "duration = 20"},
    "train_evader": {"UPDATES = 40": "UPDATES = 2"},
}
LONG = re.compile(r"(--duration |duration=)(\d+)(?:\.0)?\b")


def shortened(found: re.Match[str]) -> str:
    """Return a duration that is not long."""
    return f"{found[1]}{min(int(found[2]), SECONDS)}"


def cells(file: Path) -> Iterator[tuple[str, str]]:
    """Yield the kind and the text of each cell that does something."""
    text = LONG.sub(shortened, file.read_text(encoding="utf-8"))
    for long, short in SHORTER.get(file.stem, {}).items():
        assert long in text
        text = text.replace(long, short)
    for cell in text.split("\n# %%")[1:]:
        kind, _, body = cell.partition("\n")
        if "bash" in kind:
            yield "bash", re.sub(r"^# ?", "", body, flags=re.MULTILINE)
        elif "markdown" not in kind:
            yield "python", body


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, with the command and with what shows images."""
    command = tmp_path / "bin" / "stepaside"
    command.parent.mkdir()
    command.write_text(f'#!/bin/sh\nexec {sys.executable} -m stepaside "$@"\n')
    command.chmod(0o755)
    path = f"{command.parent}{os.pathsep}{os.environ['PATH']}"
    monkeypatch.setenv("PATH", path)
    shown: Any = ModuleType("IPython.display")
    shown.Image = lambda file, **_: Path(file).read_bytes()
    monkeypatch.setitem(sys.modules, "IPython.display", shown)
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    return work


def run_cell(text: str) -> None:
    """Run a cell of the shell; commands of the package alone in forks."""
    lines = text.replace("\\\n", " ").strip().splitlines()
    words = [shlex.split(line, comments=True) for line in lines]
    if all(w[:1] == ["stepaside"] and not SHELL & {*w} for w in words if w):
        for own in filter(None, words):
            calls.stepaside(*own[1:], cwd=Path.cwd())
    else:
        subprocess.run(["bash", "-c", text], check=True)


@pytest.mark.parametrize("file", TUTORIALS, ids=lambda file: file.stem)
def test_a_tutorial_runs(file: Path, folder: Path) -> None:
    names: dict[str, Any] = {"__name__": "__main__"}
    for kind, text in cells(file):
        if kind == "bash":
            run_cell(text)
        else:
            exec(compile(text, file.name, "exec"), names)
