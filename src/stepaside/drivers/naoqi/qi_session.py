"""Sessions of the ``qi`` library, and calls with a timeout."""

from functools import cache
from typing import Any

from ...core.errors import ConfigurationError
from ..guardian_process import SessionLost

try:
    import qi
except ImportError as error:
    raise ConfigurationError(
        "NAOqi needs its library qi: pip install 'stepaside[naoqi]'"
    ) from error

CONNECT_TIMEOUT = 5000  # in [ms]
TRACEBACK = "\n\nAt:\n"  # begins the traceback in errors of Python services


@cache
def _application() -> Any:
    """Create the application, of which a process can have only one."""
    qi.logging.setLevel(qi.logging.ERROR)
    return qi.Application(["stepaside"], raw=True)


def connect(url: str) -> Any:
    """Connect to a robot.

    Args:
        url: Address like tcp://HOST:PORT.

    Returns:
        Session; while it is open the process cannot end.

    Raises:
        SessionLost: If no robot answers.
    """
    _application()
    session = qi.Session()
    try:
        session.connect(url, _async=True).value(CONNECT_TIMEOUT)
    except RuntimeError as error:
        session.close()
        why = reason_of(error)
        raise SessionLost(f"no robot answers at {url}: {why}") from error
    return session


def ask(service: Any, method: str, *values: Any, within: float) -> Any:
    """Call a method, and wait up to ``within``, in [s], for its answer.

    Raises:
        TimeoutError: If there is no answer yet.
        SessionLost: If the call failed.
    """
    future = getattr(service, method)(*values, _async=True)
    return answer_of(future, method, within=within)


def answer_of(future: Any, what: str, *, within: float) -> Any:
    """Wait up to ``within``, in [s], for the answer of a pending call.

    Raises:
        TimeoutError: If there is no answer yet.
        SessionLost: If the call failed.
    """
    try:
        return future.value(round(1000.0 * within))
    except RuntimeError as error:
        if not future.isFinished():
            raise TimeoutError(f"{what} was not answered") from error
        raise SessionLost(f"the robot's {what}: {reason_of(error)}") from error


def reason_of(error: object) -> str:
    """Return the reason of a failed call in one line, without traceback.

    Args:
        error: Error of the ``qi`` library, or its text.
    """
    reason, _, _ = str(error).partition(TRACEBACK)
    return " ".join(reason.split()) or "no reason was given"


class Call:
    """Call that is repeated, each time after its answer has been taken.

    A late answer is not lost: it can still be taken, and no second call is
    made while one is pending.
    """

    def __init__(self, service: Any, method: str, *values: Any) -> None:
        """Prepare the call, without making it."""
        self._service, self._method, self._values = service, method, values
        self._future: Any = None

    def begin(self) -> None:
        """Make the call, unless one is pending or its answer not taken."""
        if self._future is None:
            call = getattr(self._service, self._method)
            self._future = call(*self._values, _async=True)

    def answered(self, timeout: float) -> bool:
        """Wait up to ``timeout``, in [s]; return whether the answer came."""
        self.begin()
        self._future.wait(round(1000.0 * max(timeout, 0.0)))
        return bool(self._future.isFinished())

    def take(self) -> Any:
        """Return the answer; :meth:`begin` makes a new call after it.

        Raises:
            SessionLost: If the call failed.
        """
        future, self._future = self._future, None
        return answer_of(future, self._method, within=0.0)
