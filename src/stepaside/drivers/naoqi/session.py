"""Sessions of NAOqi's messaging: connecting, listening, asking in time."""

from functools import cache
from typing import Any

from ...errors import ConfigurationError
from ..session import SessionLost

try:
    import qi
except ImportError as error:
    raise ConfigurationError(
        "NAOqi needs its messaging: pip install 'stepaside[naoqi]'"
    ) from error

CONNECTING = 5000  # longest time to connect, in [ms]


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
        raise SessionLost(f"no robot answers at {url}: {error}") from error
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
        line = " ".join(str(error).split())
        raise ConfigurationError(f"cannot listen at {url}: {line}") from error
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
        line = str(error).strip().splitlines() or ["no answer"]
        raise SessionLost(f"the robot's {what}: {line[-1]}") from error
