"""Ctrl-C is neither lost nor mistaken, whenever it comes."""

import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

import click
import pytest

from stepaside.cli.main import LazyGroup
from stepaside.cli.output_files import writes_files
from stepaside.core.interrupts import (
    DeferredInterrupt,
    interrupt,
    interruptible,
    is_loading,
    was_interrupted,
)
from stepaside.games.outcome import Outcome
from stepaside.games.recorder import PlayerRecord
from stepaside.games.walk_game import run_walk
from stepaside.games.walk_settings import WalkSettings
from stepaside.studies.code_version import ROOT

LOADERS = """
class {name}:
    def exec_module(self, call):
        return call()
"""
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def loader(name: str) -> Callable[[Callable[[], Any]], Any]:
    """What loads a module as Python's own loader of that name does."""
    file = "<frozen importlib._bootstrap_external>"
    found: dict[str, Any] = {}
    exec(compile(LOADERS.format(name=name), file, "exec"), found)
    return found[name]().exec_module  # type: ignore[no-any-return]


def loading() -> bool:
    return is_loading(sys._getframe())


def test_a_compiled_library_that_begins_is_not_interrupted() -> None:
    assert loader("ExtensionFileLoader")(loading)
    assert not loader("SourceFileLoader")(loading)
    assert not loading()


def test_an_import_itself_is_not_interrupted_but_what_it_runs_is() -> None:
    inner: dict[str, Any] = {"found": is_loading, "frame": sys._getframe}
    code = "seen = found(frame())"
    exec(compile(code, "<frozen importlib._bootstrap>", "exec"), inner)
    assert inner["seen"]
    exec(compile(code, "module.py", "exec"), inner)
    assert not inner["seen"]


def test_a_process_that_a_library_asks_as_it_loads_is_waited_for() -> None:
    asked: dict[str, Any] = {"found": is_loading, "frame": sys._getframe}
    text = "def ask(): return found(frame())"
    exec(compile(text, subprocess.__file__, "exec"), asked)
    assert loader("SourceFileLoader")(asked["ask"])
    assert not asked["ask"]()


@pytest.mark.parametrize("sign", SIGNALS)
def test_an_interrupt_comes_when_the_library_is_there(
    sign: signal.Signals,
) -> None:
    def begin() -> str:
        signal.raise_signal(sign)
        return "whole"

    whole = ""
    with interruptible(), pytest.raises(KeyboardInterrupt):
        whole = loader("ExtensionFileLoader")(begin)
        while True:
            pass
    assert whole == "whole"


class Lost:
    """Is interrupted where nobody can be told."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


def test_an_interrupt_that_nobody_could_be_told_comes_again() -> None:
    with interruptible(), pytest.raises(KeyboardInterrupt):
        Lost()
        while True:
            pass


def test_an_interrupt_while_a_lost_one_is_sent_again_is_not_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As on a busy machine, where the moment is over before it began."""
    start = threading.Timer.start
    slow = iter([True])

    def starts(timer: threading.Timer) -> None:
        start(timer)
        if next(slow, False):
            timer.join()

    monkeypatch.setattr(threading.Timer, "start", starts)
    with interruptible(), pytest.raises(KeyboardInterrupt):
        Lost()
        while True:
            pass


def mistake(sign: signal.Signals) -> None:
    """As a library does whose compiled parts ask Python things."""
    try:
        signal.raise_signal(sign)
    except KeyboardInterrupt:
        raise ValueError("invalid bounding box") from None


@pytest.mark.parametrize("sign", SIGNALS)
def test_an_interrupt_that_a_library_mistook_is_told_from_an_error(
    sign: signal.Signals,
) -> None:
    with interruptible():
        assert not was_interrupted()
        with pytest.raises(ValueError, match="bounding"):
            mistake(sign)
        assert was_interrupted()
    with interruptible():
        assert not was_interrupted()


class Group(LazyGroup):
    """Has one command."""

    def __init__(self, calls: dict[str, click.Command]) -> None:
        super().__init__("stepaside")
        self.calls = calls

    def get_command(
        self, ctx: click.Context, cmd_name: str
    ) -> click.Command | None:
        """The one that is asked for."""
        return self.calls.get(cmd_name)


@pytest.mark.parametrize("writes", [False, True])
def test_a_command_that_is_interrupted_so_says_it_in_a_line(
    writes: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    def command() -> None:
        mistake(signal.SIGTERM)

    call = click.command("draw")(writes_files(command) if writes else command)
    with pytest.raises(SystemExit) as status:
        Group({"draw": call}).main(["draw"])
    assert status.value.code == 130
    said = capsys.readouterr().err
    assert said.startswith("stepaside: interrupted; ")
    assert said.count("\n") == 1


def test_whoever_has_a_handler_keeps_it() -> None:
    def own(*_: object) -> None:
        """Do nothing."""

    before = signal.signal(signal.SIGINT, own)
    try:
        with interruptible():
            assert signal.getsignal(signal.SIGINT) is own
            assert signal.getsignal(signal.SIGTERM) is interrupt
    finally:
        signal.signal(signal.SIGINT, before)
    with interruptible():
        assert signal.getsignal(signal.SIGINT) is interrupt
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("sign", SIGNALS)
def test_an_interrupt_waits_for_what_is_being_done(
    sign: signal.Signals,
) -> None:
    whole = 0
    with (
        interruptible(),
        pytest.raises(KeyboardInterrupt),
        DeferredInterrupt() as held,
    ):
        for _ in range(3):
            held.let_through()
            signal.raise_signal(sign)
            whole += 1
    assert whole == 1


def test_the_second_interrupt_does_not_wait() -> None:
    whole = False
    with pytest.raises(KeyboardInterrupt), DeferredInterrupt():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        whole = True
    assert not whole


def test_work_without_an_end_is_interrupted_all_the_same() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), DeferredInterrupt():
        signal.raise_signal(signal.SIGINT)
        while True:
            pass
    assert signal.getsignal(signal.SIGINT) is before


def test_what_waited_is_not_lost_at_the_end_and_comes_once() -> None:
    with pytest.raises(KeyboardInterrupt), DeferredInterrupt():
        signal.raise_signal(signal.SIGINT)
    with pytest.raises(ValueError), DeferredInterrupt() as held:
        signal.raise_signal(signal.SIGINT)
        raise ValueError
    assert held._timer is None
    with DeferredInterrupt() as held:
        held.let_through()


@pytest.mark.parametrize("times", [1, 2])
def test_a_record_is_whole_whenever_ctrl_c_comes(
    times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the middle of a sample, even if it is pressed twice."""
    add = PlayerRecord.add
    count = iter(range(100))

    def pressed(record: PlayerRecord, seen: Any) -> None:
        add(record, seen)
        if next(count) == 5:
            for _ in range(times):
                signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(PlayerRecord, "add", pressed)
    run = run_walk(WalkSettings(duration=0.5))
    assert run.outcome is Outcome.INTERRUPTED and 3 < len(run.times) < 9
    lengths = {
        len(array)
        for array in (run.walker.com, run.walker.zmp, run.walker.qpos)
        if array is not None
    }
    assert lengths == {len(run.times)}


def test_little_is_loaded_before_it_is_known_what_ctrl_c_does() -> None:
    """What is loaded while nobody listens cannot be interrupted in a line."""
    code = (
        f"import sys; sys.path.insert(0, {str(ROOT.parent)!r}); "
        "before = set(sys.modules); import stepaside; "
        "print(*sorted(set(sys.modules) - before))"
    )
    said = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code],
        capture_output=True,
        text=True,
        check=True,
    )
    loaded = set(said.stdout.split())
    assert "stepaside" in loaded and not loaded & {"enum", "re", "typing"}


def test_a_terminal_that_hangs_up_interrupts_once() -> None:
    """The shell sends a SIGHUP, and the system another one."""
    with interruptible():
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGHUP)
        signal.raise_signal(signal.SIGHUP)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


def test_what_shall_survive_its_terminal_does() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with interruptible():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)
