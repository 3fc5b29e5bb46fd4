"""Validation of a strategy by trial decisions."""

from collections.abc import Callable, Iterator
from math import pi
from typing import Any

from ..core.errors import ConfigurationError
from ..core.user_file import FAILURES
from ..planning import Direction
from .knowledge import Intent, Knowledge, Limits

LIMITS = Limits(0.1, 0.2, 0.04, 0.547)


def trial_knowledge() -> Iterator[Knowledge]:
    """Yield the knowledge of a walker, from the first sighting on."""
    yield Knowledge(0.0, 0.0, 2.0, LIMITS)
    for i, bearing in enumerate((0.4, -0.4, pi, -pi)):
        yield Knowledge(
            *(0.5 * (i + 1), bearing, 1.5 - 0.4 * i, LIMITS, 0.1, 0.2, 0.05),
            moving=i > 0,
            velocity=(-0.3, 0.1),
        )


def validate_strategy(candidate: Any, name: str) -> None:
    """Check that an object behaves as a strategy.

    Args:
        candidate: Object to check.
        name: Name of the strategy, for messages.

    Raises:
        ConfigurationError: If an attribute is missing, a method fails or
            returns a wrong type, or the same knowledge and memory give
            different decisions.
    """

    def require(met: bool, rule: str, got: object) -> None:
        if not met:
            text = " ".join(str(got).split())
            raise ConfigurationError(f"strategy {name}: {rule}, got {text}")

    def attempt(rule: str, call: Callable[[], Any]) -> Any:
        try:
            return call()
        except FAILURES as error:
            require(False, rule, f"{type(error).__name__}: {error}")

    kind = type(candidate).__name__
    for method in ("begin", "decide"):
        require(
            callable(getattr(candidate, method, None)),
            f"must have a method {method}",
            f"a {kind} without",
        )
    direction, saturated = attempt(
        "must have direction and saturated",
        lambda: [
            getattr(candidate, each, None)
            for each in ("direction", "saturated")
        ],
    )
    require(
        isinstance(direction, Direction),
        "direction must be a Direction",
        repr(direction),
    )
    require(
        isinstance(saturated, bool),
        "saturated must be true or false",
        repr(saturated),
    )
    memory = attempt("begin() must return a memory", candidate.begin)
    for knowledge in trial_knowledge():
        found = [
            attempt(
                "decide(knowledge, memory) must return (Intent, memory)",
                lambda: candidate.decide(knowledge, memory),  # noqa: B023
            )
            for _ in range(2)
        ]
        for each in found:
            fits = isinstance(each, tuple) and len(each) == 2
            require(
                fits and isinstance(each[0], Intent),
                "decide must return (Intent, memory)",
                repr(each),
            )
        require(
            found[0][0] == found[1][0],
            "the same knowledge and memory must give the same intent",
            f"{found[0][0]} and then {found[1][0]}",
        )
        memory = found[0][1]
