"""NAOqi's services called in this process, without any messaging."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from velocity_fakes import until

if TYPE_CHECKING:
    from stepaside.drivers.naoqi.naoqi_body import NaoqiBody
    from stepaside.drivers.velocity.velocity_body import VelocityReport


class Answer:
    """A call that was answered at once."""

    def __init__(self, call: Callable[[], Any]) -> None:
        self._failure = ""
        self._value: Any = None
        try:
            self._value = call()
        except (RuntimeError, ValueError, KeyError, TypeError) as error:
            self._failure = f"{type(error).__name__}: {error}"

    def isFinished(self) -> bool:
        """It is."""
        return True

    def hasError(self, patience: int = 0) -> bool:
        """Whether it failed."""
        return bool(self._failure)

    def error(self, patience: int = 0) -> str:
        """Why it failed."""
        return self._failure

    def value(self, patience: int = 0) -> Any:
        """Return the answer."""
        if self._failure:
            raise RuntimeError(self._failure)
        return self._value


class Direct:
    """Service whose methods are called like those of a session."""

    def __init__(self, service: object) -> None:
        self._service = service
        self.calls: list[tuple[str, tuple[Any, ...]]] = []

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def call(*values: Any, _async: bool = False) -> Any:
            self.calls.append((name, values))
            method = getattr(self._service, name)
            answer = Answer(lambda: method(*values))
            return answer if _async else answer.value()

        return call

    def called(self, name: str) -> list[tuple[Any, ...]]:
        """Arguments of each call of a method."""
        return [values for called, values in self.calls if called == name]


def heard(body: "NaoqiBody") -> "VelocityReport":
    """Next report of a robot that stands: that answer may be on its way."""

    def told() -> "VelocityReport | None":
        report = body.listen(1.0)
        rises = report is not None and report.hindrance == "stands up"
        return None if rises else report

    report: VelocityReport = until(told)
    return report
