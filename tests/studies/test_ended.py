"""Test the files after a command was ended in any way."""

import signal
import subprocess
import sys
import threading
from time import sleep

import pytest

from stepaside.core.signal_handling import interruptible
from stepaside.core.worker_pool import worker_pool


def test_sigterm_is_ctrl_c_while_a_command_runs() -> None:
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), interruptible():
        signal.raise_signal(signal.SIGTERM)
    assert signal.getsignal(signal.SIGTERM) == before


def mask(_: int) -> tuple[bool, bool]:
    """Whether SIGINT is blocked here, and whether it is passed over."""
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    return (
        signal.SIGINT in blocked,
        signal.getsignal(signal.SIGINT) is signal.SIG_IGN,
    )


def test_workers_leave_ctrl_c_to_their_parent() -> None:
    with worker_pool(1) as pool:
        assert list(pool.map(mask, [1])) == [(False, True)]
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def fail(number: int) -> int:
    """Fail at once."""
    raise ValueError(number)


def test_a_task_that_fails_ends_the_others_and_nothing_else(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The thread that manages the workers shows no traceback of its own."""
    shown: list[object] = []
    monkeypatch.setattr(threading, "excepthook", shown.append)
    with pytest.raises(ValueError), worker_pool(1) as pool:
        list(pool.map(fail, range(9)))
    assert not shown


def test_ctrl_c_that_leaves_a_lock_taken_ends_the_pool() -> None:
    with pytest.raises(KeyboardInterrupt), worker_pool(1) as pool:
        waiting = pool.submit(sleep, 60.0)
        waiting._condition.acquire()  # before the pool's thread ends the task
        raise KeyboardInterrupt
    waiting._condition.release()


def test_the_package_is_a_command_too() -> None:
    said = subprocess.run(
        [sys.executable, "-m", "stepaside", "--version"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert "stepaside" in said.stdout and not said.stderr
