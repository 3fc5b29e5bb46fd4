"""One fuzz case, and the check of its outcome."""

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
    """Fuzz case.

    Attributes:
        kind: Class that the case is counted in.
        name: Description from which the case can be repeated by hand.
        run: Runs the case in a new folder, which is the current one; returns
            a description of the failure, or an empty string.
        deadline: Time in which the case must end by itself, in [s].
    """

    kind: str
    name: str
    run: Callable[[Path], str]
    deadline: float = DEADLINE


class Hang(BaseException):
    """Raised in a case that does not end after an interruption."""


class Reached(BaseException):
    """Raised when work would begin: the input was accepted."""


class Clock:
    """Time limit of a case, in processor time and in waiting time.

    Attributes:
        interrupted: Whether the case was interrupted.
    """

    def __init__(self, limit: float) -> None:
        """Start the clock with a time limit, in [s]."""
        self.interrupted = False
        self._begin(limit)

    def _begin(self, limit: float) -> None:
        self._worked = process_time() + limit
        self._waited = monotonic() + limit * WAITS

    def ring(self, *_: Any) -> None:
        """Interrupt as Ctrl-C does; raise ``Hang`` after a second limit."""
        if process_time() < self._worked and monotonic() < self._waited:
            return
        if self.interrupted:
            raise Hang
        self.interrupted = True
        self._begin(PATIENCE)
        os.kill(os.getpid(), signal.SIGINT)


@contextmanager
def watched(deadline: float) -> Iterator[Clock]:
    """Interrupt a case that exceeds its time limit."""
    clock = Clock(deadline)
    before = signal.signal(signal.SIGALRM, clock.ring)
    outer = signal.setitimer(signal.ITIMER_REAL, LOOK, LOOK)
    began = monotonic()
    try:
        yield clock
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
        if outer[0]:  # an outer supervisor has its own clock
            left = max(outer[0] - (monotonic() - began), 0.001)
            signal.setitimer(signal.ITIMER_REAL, left, outer[1])


def complaint_of(case: Case) -> str:
    """Run a case; return a description of its failure, or an empty string."""
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
    """Return an error and its origin, on one line."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [f for f in frames if "stepaside" in f.filename] or frames[-1:]
    where = f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own else ""
    return f"{type(error).__name__} at {where}: {str(error)[:200]!r}"
