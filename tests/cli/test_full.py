"""Full, read-only or missing output: one line, nothing half-written."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from itertools import count, cycle
from pathlib import Path
from random import Random

import click
import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import all_commands, main
from stepaside.core import atomic_output as outputs
from tools.fuzz import places
from tools.fuzz.case import complaint_of
from tools.fuzz.kinds import make_run
from tools.fuzz.outlets import APART, is_outlet, outlets, words_of, writers
from tools.fuzz.places import FAULTS, place_case

pytestmark = pytest.mark.usefixtures("blank_figures")

DUEL = "duel --duration=0.02 --output={}/run"
PLAN = "plan --role=evader --bearing=0.3 --steps=4 --figure={}/plan.png"
QUICK = ("room", "robot show", "plan", "robot init", "compare", "tournament")


@pytest.fixture
def small(tmp_path: Path) -> Iterator[Path]:
    """Mount an empty file system of 8 kB."""
    if not sys.platform.startswith("linux") or os.geteuid() != 0:
        pytest.skip("only root mounts file systems, on Linux")
    place = tmp_path / "small"
    place.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", "size=8k", "none", str(place)]
    if subprocess.run(words, capture_output=True).returncode:
        pytest.skip("nothing can be mounted here")
    yield place
    subprocess.run(["umount", "--lazy", str(place)], check=True)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("full") / "run"
    make_run(folder)
    return folder


def said(words: list[str], place: Path) -> Result:
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2, result.output
    assert not list(place.rglob("*"))
    return result


@pytest.mark.parametrize("name", writers())
def test_full_or_read_only_output_is_refused_before_work(
    name: str, small: Path, run: Path
) -> None:
    """For every command and every output option."""
    words = words_of(name, run, small)
    result = said(words, small)
    assert result.stdout == "" and result.stderr.count("\n") == 1
    assert "bytes are free" in result.stderr
    subprocess.run(["mount", "-o", "remount,ro", str(small)], check=True)
    result = said(words, small)
    assert result.stdout == "" and result.stderr.count("\n") == 1
    assert "read-only file system" in result.stderr


@pytest.mark.parametrize("words", [DUEL, PLAN])
def test_disk_that_fills_during_work_loses_no_result(
    words: str, small: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Results are printed; a run is saved where the message says."""
    monkeypatch.setattr(outputs, "MIN_FREE_SPACE", 0)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    result = said(words.format(small).split(), small)
    assert result.stdout  # what it came to
    lines = result.stderr.splitlines()
    assert "no space left on device" in lines[-1]
    kept = list(tmp_path.glob("stepaside-run/summary.json"))
    assert len(lines) == (2 if words == DUEL else 1)
    assert bool(kept) == (words == DUEL)


@pytest.mark.parametrize(
    ("name", "fault"), [*zip(QUICK, cycle(FAULTS), strict=False)]
)
def test_output_that_vanishes_during_work_loses_no_result(
    name: str, fault: str, run: Path
) -> None:
    """``python -m tools.fuzz --kinds places`` tries all moments."""
    for part in (Random(name).random(), 0.7):
        assert complaint_of(place_case(name, run, fault, part)) == ""


def test_every_output_option_is_fuzzed() -> None:
    """Except those of commands that wait for clients."""
    told = {
        (name, option.opts[0])
        for name, command in all_commands().items()
        for option in command.params
        if isinstance(option, click.Option) and is_outlet(option)
    }
    tried = {(name, o.opts[0]) for name in writers() for o in outlets(name)}
    assert {name for name, _ in told - tried} == APART
    assert ("duel", "--output") in tried and ("replay", "--video") in tried


def half_written(file: Path) -> None:
    (file.parent / f"{outputs.DRAFT}x").write_text("")
    click.echo("stepaside: it could not be written", err=True)
    raise SystemExit(2)


def unsaid(file: Path) -> None:
    file.unlink(missing_ok=True)


def failing(file: Path) -> None:
    raise KeyError(file)


def untold(file: Path) -> None:
    raise SystemExit(2)


WRONG: dict[Callable[[Path], None], str] = {
    half_written: "leftovers",
    unsaid: "lost: figure.png",
    failing: "traceback: KeyError",
    untold: "no word",
}


@pytest.mark.parametrize("fault", WRONG)
def test_fuzzer_detects_broken_output(
    fault: Callable[[Path], None], run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = count()

    @click.command(context_settings={"ignore_unknown_options": True})
    @click.option("--output", type=Path)
    @click.option("--figure", type=Path)
    @click.argument("others", nargs=-1)
    def room(output: Path, figure: Path, others: tuple[str, ...]) -> None:
        click.echo("a room")
        output.write_text("x")
        figure.write_bytes(b"\x89PNG IEND sum")
        if next(calls):
            fault(figure)

    fake = click.Group("fake", {"room": room})
    monkeypatch.setattr(places, "main", fake)
    monkeypatch.setitem(FAULTS, "none", lambda place: None)
    places.undisturbed.cache_clear()
    try:
        got = complaint_of(place_case("room", run, "none", 0.99))
    finally:
        places.undisturbed.cache_clear()
    assert got.startswith(WRONG[fault]), got
