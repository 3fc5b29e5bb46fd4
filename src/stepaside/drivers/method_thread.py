"""Thread that calls the methods of a robot, which may fail or block."""

import logging
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from threading import Thread
from time import monotonic, sleep
from typing import Any, TypeVar

from ..core.errors import FAILURES, ConfigurationError, StepAsideError

OPEN_TIMEOUT = 15.0  # for open(), in [s]
SIMULATOR_TIMEOUT = 60.0  # for open() of a simulator that may be busy, in [s]
CLOSE_TIMEOUT = 2.0  # for the last methods of a session, in [s]
BLOCKED = 0.25  # time after which a method counts as blocked, in [s]
PAUSE = 0.1  # between two attempts to connect, in [s]
log = logging.getLogger(__name__)
Opened = TypeVar("Opened")


class SessionLost(StepAsideError, ConnectionError):
    """The connection to the robot failed or its data cannot be trusted."""


class MethodThread:
    """Thread that calls the methods of a robot, one after the other.

    A method that does not return blocks this thread, and not control.
    """

    def __init__(
        self,
        robot: Any,
        *,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Start the thread."""
        self.robot, self.clock = robot, clock
        self._queue: SimpleQueue[tuple[str, Any, Future[Any]] | None] = (
            SimpleQueue()
        )
        self._running: tuple[str, float] | None = None
        Thread(target=self._work, daemon=True).start()

    @property
    def blocked(self) -> tuple[str, float] | None:
        """The method that has been running for too long, and its time [s]."""
        running = self._running
        if running is None:
            return None
        waited = self.clock() - running[1]
        return (running[0], waited) if waited > BLOCKED else None

    def begin(self, method: str, call: Any = None) -> "Future[Any]":
        """Call a method, or a call by its name, after those begun before."""
        result: Future[Any] = Future()
        self._queue.put((method, call or getattr(self.robot, method), result))
        return result

    def run(self, method: str, within: float, call: Any = None) -> Any:
        """Call a method and wait for its result up to a time in [s]."""
        try:
            return self.begin(method, call).result(within)
        except TimeoutError as error:
            raise SessionLost(
                f"{self.name_of(method)} did not return within {within:g} s"
            ) from error

    def open(self, timeout: float = OPEN_TIMEOUT) -> None:
        """Connect to the robot."""
        try:
            self.run("open", timeout)
        except SessionLost as error:
            if isinstance(error.__cause__, OSError):
                raise
            raise ConfigurationError(str(error)) from error

    def call_apart(self, method: str) -> "Future[Any]":
        """Call a method at once, in a thread of its own."""
        result: Future[Any] = Future()
        call = method, getattr(self.robot, method), result
        Thread(target=self._call, args=call, daemon=True).start()
        return result

    def name_of(self, method: str) -> str:
        """Return the name of a method for messages."""
        return f"{method}() of {type(self.robot).__name__}"

    def end(self) -> None:
        """End the thread after the methods that were begun."""
        self._queue.put(None)

    def _work(self) -> None:
        while (entry := self._queue.get()) is not None:
            if not entry[2].set_running_or_notify_cancel():
                continue
            self._running = entry[0], self.clock()
            self._call(*entry)
            self._running = None

    def _call(self, method: str, call: Any, result: "Future[Any]") -> None:
        try:
            result.set_result(call())
        except FAILURES as error:
            why = f"{type(error).__name__}: {error}"
            if not str(error):
                why = repr(error)
            lost = SessionLost(f"{self.name_of(method)} failed: {why}")
            lost.__cause__ = error
            result.set_exception(lost)


def open_with_retries(
    open_robot: Callable[[], Opened], patience: float
) -> Opened:
    """Connect to a robot, retrying for a time in [s]; 0 tries once."""
    deadline = monotonic() + patience
    is_logged = False
    while True:
        try:
            return open_robot()
        except SessionLost as error:
            if monotonic() >= deadline:
                raise
            if not is_logged:
                log.info("%s; retrying for up to %g s", error, patience)
                is_logged = True
            sleep(PAUSE)
