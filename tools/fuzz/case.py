"""One piece of bad input, and what may come of it."""

import os
import signal
import tempfile
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic, process_time
from typing import Any, NamedTuple

# Processor time, which other work on the machine does not lengthen, in [s]:
DEADLINE = 6.0  # in which a case ends by itself
PATIENCE = 10.0  # after which it has ended since it was interrupted
WAITS = 10.0  # what only waits may wait so many times as long, in [1]
LOOK = 0.1  # how often its clock is looked at, in [s]


class Case(NamedTuple):
    """A piece of input.

    Attributes:
        kind: Class that it is counted in.
        name: What is tried, so that somebody can try it by hand.
        run: Tries it in a folder of its own, which is the current one; gives
            what is wrong, or nothing.
        deadline: In which it ends by itself, in [s].
    """

    kind: str
    name: str
    run: Callable[[Path], str]
    deadline: float = DEADLINE


class Hang(BaseException):
    """A case did not end though it was interrupted."""


class Reached(BaseException):
    """Work began: what was given is taken."""


class Clock:
    """Whether the time of a case is up: that it works, or that it waits.

    Attributes:
        interrupted: Whether it was interrupted.
    """

    def __init__(self, limit: float) -> None:
        """Begin with time left, in [s]."""
        self.interrupted = False
        self._begin(limit)

    def _begin(self, limit: float) -> None:
        self._worked = process_time() + limit
        self._waited = monotonic() + limit * WAITS

    def ring(self, *_: Any) -> None:
        """Interrupt as Ctrl-C does, and later for good."""
        if process_time() < self._worked and monotonic() < self._waited:
            return
        if self.interrupted:
            raise Hang
        self.interrupted = True
        self._begin(PATIENCE)
        os.kill(os.getpid(), signal.SIGINT)


@contextmanager
def watched(deadline: float) -> Iterator[Clock]:
    """Interrupt what lasts longer than its time."""
    clock = Clock(deadline)
    before = signal.signal(signal.SIGALRM, clock.ring)
    outer = signal.setitimer(signal.ITIMER_REAL, LOOK, LOOK)
    began = monotonic()
    try:
        yield clock
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        if outer[0]:  # whoever watches us has a clock of its own
            left = max(outer[0] - (monotonic() - began), 0.001)
            signal.setitimer(signal.ITIMER_REAL, left, outer[1])


def complaint_of(case: Case) -> str:
    """Try a case; what is wrong with what came of it, or nothing."""
    here = os.getcwd()
    with tempfile.TemporaryDirectory(prefix="fuzz-") as name:
        os.chdir(name)
        try:
            with watched(case.deadline):
                return case.run(Path(name))
        except Hang:
            return "hang"
        except KeyboardInterrupt:
            return "hang: it ended only when it was interrupted"
        except Exception as error:
            return f"traceback: {told(error)}"
        finally:
            os.chdir(here)


def told(error: BaseException) -> str:
    """An error and where it came from, on one line."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [f for f in frames if "stepaside" in f.filename] or frames[-1:]
    where = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own else ""
    return f"{type(error).__name__} at {where}: {str(error)[:200]!r}"
