"""Test Ctrl-C, SIGTERM and SIGHUP: handled alike, deferred within a tick."""

import signal
from typing import Any

import pytest

from stepaside.core.signal_handling import (
    DeferredInterrupt,
    interrupted_status,
    interruptible,
)
from stepaside.games.game import Outcome
from stepaside.games.game_settings import walk
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import run_game

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@pytest.mark.parametrize("number", SIGNALS)
def test_every_signal_raises_keyboard_interrupt(
    number: signal.Signals,
) -> None:
    """The first one gives the status of the command."""
    with interruptible():
        for each in (number, signal.SIGINT):
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(each)
        assert interrupted_status() == 128 + number


@pytest.mark.parametrize("number", SIGNALS)
def test_an_interrupt_is_deferred_until_let_through(
    number: signal.Signals,
) -> None:
    completed = 0
    with (
        interruptible(),
        pytest.raises(KeyboardInterrupt),
        DeferredInterrupt() as deferred,
    ):
        for _ in range(3):
            deferred.let_through()
            signal.raise_signal(number)
            completed += 1
    assert completed == 1


def test_the_second_interrupt_is_not_deferred() -> None:
    completed, before = False, signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), DeferredInterrupt():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        completed = True
    assert not completed and signal.getsignal(signal.SIGINT) is before


def test_a_pending_interrupt_is_raised_once_at_the_end() -> None:
    with pytest.raises(KeyboardInterrupt), DeferredInterrupt():
        signal.raise_signal(signal.SIGINT)
    with pytest.raises(ValueError, match="own"), DeferredInterrupt():
        signal.raise_signal(signal.SIGINT)
        raise ValueError("own")
    with DeferredInterrupt() as deferred:
        deferred.let_through()


@pytest.mark.parametrize("times", [1, 2])
def test_an_interrupted_record_has_complete_samples(
    times: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C arrives once or twice within a sample."""
    sample = RobotPlayer.sample
    count = iter(range(100))

    def sample_and_interrupt(player: RobotPlayer, *, closely: bool) -> Any:
        if next(count) == 5:
            for _ in range(times):
                signal.raise_signal(signal.SIGINT)
        return sample(player, closely=closely)

    monkeypatch.setattr(RobotPlayer, "sample", sample_and_interrupt)
    run = run_game(walk(duration=0.5))
    assert run.outcome is Outcome.INTERRUPTED and 3 < len(run.times) < 9
    lengths = {
        len(array)
        for array in (run.walker.com, run.walker.zmp, run.walker.qpos)
        if array is not None
    }
    assert lengths == {len(run.times)}


def test_a_closed_terminal_interrupts_once() -> None:
    """Both the shell and the kernel send SIGHUP."""
    with interruptible():
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGHUP)
        signal.raise_signal(signal.SIGHUP)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)


def test_an_ignored_sighup_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with interruptible():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)
