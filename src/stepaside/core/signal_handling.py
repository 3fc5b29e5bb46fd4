"""Ctrl-C, SIGTERM and SIGHUP: handled alike, and deferred while playing."""

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
DEFAULT_HANDLERS = (signal.default_int_handler, signal.SIG_DFL)

_raised: list[int] = []  # signals that raised KeyboardInterrupt


@contextmanager
def interruptible() -> Iterator[None]:
    """Let SIGTERM and SIGHUP raise KeyboardInterrupt, as Ctrl-C does.

    A custom handler of SIGINT stays installed, and a process that ignores
    SIGHUP (``nohup``) goes on ignoring it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {}
    for number in SIGNALS:
        handler = signal.getsignal(number)
        if number == signal.SIGTERM or handler in DEFAULT_HANDLERS:
            before[number] = signal.signal(number, interrupt)
    try:
        yield
    finally:
        _raised.clear()
        for number, handler in before.items():
            signal.signal(number, handler)


def interrupted_status() -> int:
    """Return the exit status of a command after the first signal.

    It is that of a shell, 128 plus the number of the signal.
    """
    return 128 + (_raised[0] if _raised else signal.SIGINT)


class DeferredInterrupt:
    """Context that defers interrupts to points where all data is complete.

    A deferred signal reaches its handler at the next :meth:`let_through`, or
    when a second signal arrives.
    """

    def __init__(self) -> None:
        """Start without a pending signal."""
        self._before: dict[int, Any] = {}
        self._pending: int | None = None

    def __enter__(self) -> "DeferredInterrupt":
        """Install the deferring handler for signals that have a handler."""
        if threading.current_thread() is threading.main_thread():
            for number in SIGNALS:
                if callable(before := signal.getsignal(number)):
                    self._before[number] = before
                    signal.signal(number, self._defer)
        return self

    def __exit__(self, *error: object) -> None:
        """Handle a pending signal, unless another error propagates."""
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if error[0] is None:
            self.let_through()

    def let_through(self) -> None:
        """Call the handler of a pending signal, if there is one."""
        number, self._pending = self._pending, None
        if number is not None:
            self._before[number](number, sys._getframe())

    def _defer(self, number: int, frame: FrameType | None) -> None:
        if self._pending is None:
            self._pending = number
        else:
            self._pending = None
            self._before[number](number, frame)


def interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt; handler of all three signals.

    When a terminal closes, both the shell and the kernel send SIGHUP; only
    the first one raises, so that the second does not interrupt the cleanup.
    """
    if number == signal.SIGHUP and number in _raised:
        return
    _raised.append(number)
    raise KeyboardInterrupt
