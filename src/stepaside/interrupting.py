"""Ctrl-C and SIGTERM end a command, also while it loads its libraries.

An interrupt that comes while a compiled library begins is taken for an error
of that library, and one that comes while Python tidies up after an import is
passed over: so neither is raised there, but a moment later.
"""

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

AGAIN = 0.01  # after which it is tried again, in [s]
IMPORTING = "<frozen importlib._bootstrap"  # and ..._external>
COMPILED = ("create_module", "exec_module")  # of a loader


@contextmanager
def stoppable() -> Iterator[None]:
    """Let SIGTERM end what runs as Ctrl-C does: what is done is kept.

    Whoever has a handler of their own for Ctrl-C keeps it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {signal.SIGTERM: signal.signal(signal.SIGTERM, interrupt)}
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        before[signal.SIGINT] = signal.signal(signal.SIGINT, interrupt)
    unraisable = sys.unraisablehook
    sys.unraisablehook = _again_if_lost
    try:
        yield
    finally:
        sys.unraisablehook = unraisable
        for number, handler in before.items():
            signal.signal(number, handler)


def interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, where it is not lost.

    Raises:
        KeyboardInterrupt: Now, or a moment later.
    """
    if not is_loading(frame):
        raise KeyboardInterrupt
    _again(number)


def is_loading(frame: FrameType | None) -> bool:
    """Whether an exception would be lost or mistaken in a frame.

    Args:
        frame: Where Python is.
    """
    innermost = True
    while frame is not None:
        code = frame.f_code
        if code.co_filename.startswith(IMPORTING):
            loader = frame.f_locals.get("self")
            if innermost or (
                code.co_name in COMPILED
                and type(loader).__name__ == "ExtensionFileLoader"
            ):
                return True
        innermost, frame = False, frame.f_back
    return False


def _again(number: int) -> None:
    """Send a signal to the main thread once more, after a moment."""
    main = threading.main_thread().ident
    assert main is not None
    timer = threading.Timer(AGAIN, signal.pthread_kill, (main, number))
    timer.daemon = True
    timer.start()


def _again_if_lost(lost: "sys.UnraisableHookArgs") -> None:
    """Interrupt once more if nobody could be told."""
    if issubclass(lost.exc_type, KeyboardInterrupt):
        _again(signal.SIGINT)
    else:
        sys.__unraisablehook__(lost)
