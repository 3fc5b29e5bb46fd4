"""A little of ``python -m tools.fuzz``, and that it notices what is wrong."""

import os
import re
import signal
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from random import Random
from time import sleep

import click
import pytest

from tools.fuzz import invoking
from tools.fuzz.case import Case, complaint_of, watched
from tools.fuzz.commands import command_cases
from tools.fuzz.invoking import command_case
from tools.fuzz.kinds import KINDS, make_run, warm_up

# Cases of each kind: a second of each, drawn anew when the code changes.
NUMBER = {
    "options": 45,
    "settings": 400,
    "folders": 60,
    "calls": 300,
    "sockets": 60,
}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fuzz") / "run"
    make_run(folder)
    warm_up()
    return folder


@pytest.mark.parametrize("kind", NUMBER)
def test_invalid_input_is_refused_in_one_line(kind: str, run: Path) -> None:
    if kind == "sockets":
        pytest.importorskip("viser")
    cases = KINDS[kind](Random(7), run)
    wrong = {
        case.name: complaint
        for case in islice(cases, NUMBER[kind])
        if (complaint := complaint_of(case))
    }
    assert not wrong


def test_every_command_and_most_options_are_tried(run: Path) -> None:
    from stepaside.cli.main import all_commands

    tried = {case.kind for case in command_cases(Random(0), run)}
    assert tried == {f"options of {name}" for name in all_commands()}


@click.group()
def fake() -> None:
    """Do wrong in one way each."""


@fake.command()
def fails() -> None:
    """Show a traceback."""
    raise KeyError("x")


@fake.command()
def hangs() -> None:
    """Never end."""
    while True:
        try:
            sleep(0.01)
        except KeyboardInterrupt:
            pass


@fake.command()
def accepts() -> None:
    """Take anything."""


@fake.command()
def leaves() -> None:
    """Leave something when it refuses."""
    Path("left").write_text("")
    click.echo("no", err=True)
    raise SystemExit(2)


@fake.command()
def loses() -> None:
    """Write over what is there."""
    Path("file").write_text("")


@fake.command()
def chats() -> None:
    """Refuse in many lines."""
    click.echo("one\ntwo", err=True)
    raise SystemExit(2)


@fake.command()
def odd() -> None:
    """End with a status of its own."""
    raise SystemExit(7)


@fake.command()
@click.option("--json/--no-json")
def infinite(json: bool) -> None:
    """Print what is no JSON."""
    click.echo('{"x": NaN}')


WRONG = {
    "fails": "traceback: KeyError",
    "hangs": "hang",
    "accepts": "accepted nonsense",
    "leaves": "leftovers: \\['left'\\]",
    "loses": "lost: file",
    "chats": "more than a line",
    "odd": "status 7",
    "infinite --json": "no JSON",
}


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr("fuzz.case.PATIENCE", 0.1)
    monkeypatch.setattr("fuzz.case.WAITS", 1.0)
    yield


@pytest.mark.parametrize("words", WRONG)
def test_failures_are_detected(
    words: str, monkeypatch: pytest.MonkeyPatch, quick: None
) -> None:
    monkeypatch.setattr(invoking, "main", fake)
    refused = words == "accepts"
    case = command_case("fake", words.split(), refused=refused, deadline=0.1)
    got = complaint_of(case)
    assert re.match(WRONG[words], got), got


def test_case_that_ends_only_at_ctrl_c_hangs(quick: None) -> None:
    def slow(_: Path) -> str:
        sleep(9.0)
        return ""

    assert "interrupted" in complaint_of(Case("x", "x", slow, 0.1))


def test_nested_clock_restores_the_outer_one() -> None:
    rung: list[int] = []
    before = signal.signal(signal.SIGALRM, lambda *_: rung.append(1))
    outer = signal.setitimer(signal.ITIMER_REAL, 100.0)
    try:
        with watched(50.0):
            pass
        left, _ = signal.getitimer(signal.ITIMER_REAL)
        assert 90.0 < left <= 100.0 and not rung
    finally:
        signal.signal(signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, *outer)
    assert os.getcwd()
