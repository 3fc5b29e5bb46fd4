"""Ctrl-C, SIGTERM and SIGHUP end a command, also while it loads libraries.

An interrupt that comes while a compiled library begins is taken for an error
of that library, and one that comes while Python tidies up after an import is
passed over; a process that a library asks as it loads would die with words of
its own. So none is raised there, but a moment later. One that comes while a
game is at a tick waits for the end of that, so that the record is whole. One
that a library mistook for an error of its own all the same, as those do whose
compiled parts ask Python things, is told from such an error afterwards.
"""

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

AGAIN = 0.01  # after which it is tried again, in [s]
LONGEST = 0.5  # that an interrupt is kept back for a whole, in [s]
IMPORTING = "<frozen importlib._bootstrap"  # and ..._external>
ASKING = os.path.join(os.path.dirname(os.__file__), "subprocess.py")
ENDINGS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
BY_DEFAULT = (signal.default_int_handler, signal.SIG_DFL)
COMPILED = ("create_module", "exec_module")  # of a loader

_raised: set[int] = set()  # signals that were told to what runs


@contextmanager
def interruptible() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end what runs as Ctrl-C does.

    What is done is kept. A handler of one's own for Ctrl-C stays, and a
    process that is told to survive its terminal (``nohup``) does.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _raised.clear()
    before = {}
    for number in ENDINGS:
        handler = signal.getsignal(number)
        if number == signal.SIGTERM or handler in BY_DEFAULT:
            before[number] = signal.signal(number, interrupt)
    unraisable = sys.unraisablehook
    sys.unraisablehook = _again_if_lost
    try:
        yield
    finally:
        sys.unraisablehook = unraisable
        for number, handler in before.items():
            signal.signal(number, handler)


class DeferredInterrupt:
    """Keeps what ends a command back until what is being done is whole.

    Within it, whoever handles them is called where the work says that it is
    whole, when they come a second time, or after half a second.
    """

    def __init__(self) -> None:
        """Begin with nothing that was kept back."""
        self._before: dict[int, Any] = {}
        self._waits: int | None = None
        self._timer: threading.Timer | None = None

    def __enter__(self) -> "DeferredInterrupt":
        """Keep back what somebody handles."""
        if threading.current_thread() is threading.main_thread():
            for number in ENDINGS:
                if callable(before := signal.getsignal(number)):
                    self._before[number] = before
                    signal.signal(number, self._keep)
        return self

    def __exit__(self, *error: object) -> None:
        """Let what was kept back through, unless an error goes first."""
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if error[0] is None:
            self.let_through()
        else:
            self._forget()

    def let_through(self) -> None:
        """Say that all is whole; what was kept back is handled now."""
        number = self._forget()
        if number is not None:
            self._before[number](number, sys._getframe())

    def _keep(self, number: int, frame: FrameType | None) -> None:
        if self._waits is None:
            self._waits = number
            self._timer = _again(number, LONGEST)
        else:
            self._forget()
            self._before[number](number, frame)

    def _forget(self) -> int | None:
        """What waits, which does so no more."""
        if self._timer is not None:
            self._timer.cancel()
        number, self._waits, self._timer = self._waits, None, None
        return number


def interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, where it is not lost.

    A terminal that hangs up says so once: the shell and the system each
    send a SIGHUP then, and the second is no second wish.

    Raises:
        KeyboardInterrupt: Now, or a moment later.
    """
    if number == signal.SIGHUP and number in _raised:
        return
    if not is_loading(frame):
        _raised.add(number)
        raise KeyboardInterrupt
    _again(number)


def was_interrupted() -> bool:
    """Whether an error that nobody expects may have been an interrupt."""
    return bool(_raised)


def is_loading(frame: FrameType | None) -> bool:
    """Whether an exception would be lost or mistaken in a frame.

    Args:
        frame: Where Python is.
    """
    innermost, waits = True, False
    while frame is not None:
        code = frame.f_code
        waits |= code.co_filename == ASKING
        if code is _again_if_lost.__code__:  # nobody could be told of this
            return True
        if code.co_filename.startswith(IMPORTING):
            loader = frame.f_locals.get("self")
            if (
                innermost
                or waits
                or (
                    code.co_name in COMPILED
                    and type(loader).__name__ == "ExtensionFileLoader"
                )
            ):
                return True
        innermost, frame = False, frame.f_back
    return False


def _again(number: int, after: float = AGAIN) -> threading.Timer:
    """Send a signal to the main thread once more, after a moment."""
    main = threading.main_thread().ident
    assert main is not None
    timer = threading.Timer(after, signal.pthread_kill, (main, number))
    timer.daemon = True
    timer.start()
    return timer


def _again_if_lost(lost: "sys.UnraisableHookArgs") -> None:
    """Interrupt once more if nobody could be told."""
    if issubclass(lost.exc_type, KeyboardInterrupt):
        _again(signal.SIGINT)
    else:
        sys.__unraisablehook__(lost)
