"""A file system that is full or read-only: one line, nothing half-written."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result

from fuzz.places import APART, WRITES
from stepaside import outputs
from stepaside.cli import all_commands, main
from stepaside.commands.declared.kinds import OutputFile

DUEL = "duel --duration=0.02 --output={}/run"
PLAN = "plan --role=evader --bearing=0.3 --steps=4 --figure={}/plan.png"
GAME = "unicycles --duration=1 --figure={}/game.svg"
ASKED = (DUEL, PLAN, GAME)


@pytest.fixture
def small(tmp_path: Path) -> Iterator[Path]:
    """A file system with room for 8 kB, empty."""
    if not sys.platform.startswith("linux") or os.geteuid() != 0:
        pytest.skip("only root mounts file systems, on Linux")
    place = tmp_path / "small"
    place.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", "size=8k", "none", str(place)]
    if subprocess.run(words, capture_output=True).returncode:
        pytest.skip("nothing can be mounted here")
    yield place
    subprocess.run(["umount", "--lazy", str(place)], check=True)


def said(words: str, place: Path) -> Result:
    result = CliRunner().invoke(main, words.format(place).split())
    assert result.exit_code == 2, result.output
    assert not list(place.rglob("*"))
    return result


@pytest.mark.parametrize("words", ASKED)
def test_a_full_place_is_refused_before_work(words: str, small: Path) -> None:
    result = said(words, small)
    assert result.stdout == "" and result.stderr.count("\n") == 1
    assert "bytes are free" in result.stderr


@pytest.mark.parametrize("words", ASKED)
def test_a_read_only_place_is_refused_before_work(
    words: str, small: Path
) -> None:
    subprocess.run(["mount", "-o", "remount,ro", str(small)], check=True)
    result = said(words, small)
    assert result.stdout == "" and result.stderr.count("\n") == 1
    assert "read-only file system" in result.stderr


@pytest.mark.parametrize("words", ASKED)
def test_a_place_that_fills_meanwhile_costs_no_result(
    words: str, small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was computed is printed; a run is kept where it says."""
    monkeypatch.setattr(outputs, "ROOM", 0)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    result = said(words, small)
    assert result.stdout  # what it came to
    lines = result.stderr.splitlines()
    assert "no space left on device" in lines[-1]
    kept = list(tmp_path.glob("stepaside-run/summary.json"))
    assert len(lines) == (2 if words == DUEL else 1)
    assert bool(kept) == (words == DUEL)


def writes(command: click.Command) -> bool:
    """Whether a command is told where to write."""
    for param in command.params:
        kind = param.type
        if isinstance(kind, OutputFile) or "--output" in param.opts:
            return True
    return False


def test_every_command_that_writes_is_tried() -> None:
    """``python -m tests.fuzz --kinds places`` tries them."""
    found = {name for name, each in all_commands().items() if writes(each)}
    assert found <= {*WRITES, *APART}
    assert {*WRITES, *APART} <= found | {"reproduce"}
