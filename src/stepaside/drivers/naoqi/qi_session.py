"""Sessions of NAOqi's messaging: connecting, listening, asking in time."""

from functools import cache
from typing import Any

from ...core.errors import ConfigurationError
from ..guardian_process import SessionLost

try:
    import qi
except ImportError as error:
    raise ConfigurationError(
        "NAOqi needs its messaging: pip install 'stepaside[naoqi]'"
    ) from error

CONNECTING = 5000  # longest time to connect, in [ms]
SOURCE = "\n\nAt:\n"  # after it come files and lines of a service in Python


@cache
def _application() -> Any:
    """The one application that a process may have."""
    qi.logging.setLevel(qi.logging.ERROR)
    return qi.Application(["stepaside"], raw=True)


def connect(url: str) -> Any:
    """Connect to a robot.

    Args:
        url: Like tcp://HOST:PORT.

    Returns:
        A session; an open one keeps the process from ending.

    Raises:
        SessionLost: If nobody answers there.
    """
    _application()
    session = qi.Session()
    try:
        session.connect(url, _async=True).value(CONNECTING)
    except RuntimeError as error:
        session.close()
        why = reason_of(error)
        raise SessionLost(f"no robot answers at {url}: {why}") from error
    return session


def listen(url: str, services: dict[str, Any]) -> Any:
    """Offer services, with a directory of their own.

    Args:
        url: Like tcp://127.0.0.1:PORT.
        services: Objects whose methods are called, by name.

    Raises:
        ConfigurationError: If nobody can listen there.
    """
    _application()
    session = qi.Session()
    try:
        session.listenStandalone(url)
        for name, service in services.items():
            session.registerService(name, service)
    except RuntimeError as error:
        session.close()
        why = reason_of(error)
        raise ConfigurationError(f"cannot listen at {url}: {why}") from error
    return session


def ask(service: Any, method: str, *values: Any, within: float) -> Any:
    """Call a method, and wait for its answer for some time, in [s].

    Raises:
        TimeoutError: If none came yet.
        SessionLost: If there will be none.
    """
    future = getattr(service, method)(*values, _async=True)
    return answer_of(future, method, within=within)


def answer_of(future: Any, what: str, *, within: float) -> Any:
    """Answer of a call that was made, waited for for some time, in [s].

    Raises:
        TimeoutError: If none came yet.
        SessionLost: If there will be none.
    """
    try:
        return future.value(round(1000.0 * within))
    except RuntimeError as error:
        if not future.isFinished():
            raise TimeoutError(f"{what} was not answered") from error
        raise SessionLost(f"the robot's {what}: {reason_of(error)}") from error


def reason_of(error: object) -> str:
    """Return the whole reason for which a call was refused, in one line.

    What a service in Python adds of its own source is left out.

    Args:
        error: What the messaging raised, or the text of it.
    """
    reason, _, _ = str(error).partition(SOURCE)
    return " ".join(reason.split()) or "no reason was given"


class Call:
    """A call that is repeated, each time after its answer has come.

    An answer that is late is not lost: the next look finds it, and no
    second call is made while it is on its way.
    """

    def __init__(self, service: Any, method: str, *values: Any) -> None:
        """Make no call yet."""
        self._service, self._method, self._values = service, method, values
        self._future: Any = None

    def begin(self) -> None:
        """Make the call, unless one is on its way or its answer waits."""
        if self._future is None:
            call = getattr(self._service, self._method)
            self._future = call(*self._values, _async=True)

    def answered(self, patience: float) -> bool:
        """Wait for the answer for some time, in [s]; whether it is here."""
        self.begin()
        self._future.wait(round(1000.0 * max(patience, 0.0)))
        return bool(self._future.isFinished())

    def take(self) -> Any:
        """Return the answer that is here; the next look calls anew.

        Raises:
            SessionLost: If the call was refused, or the robot is gone.
        """
        future, self._future = self._future, None
        return answer_of(future, self._method, within=0.0)
