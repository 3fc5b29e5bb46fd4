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

    def attempt(rule: str, call: Callable[..., Any], *given: Any) -> Any:
        try:
            return call(*given)
        except FAILURES as error:
            require(False, rule, f"{type(error).__name__}: {error}")

    kind = type(candidate).__name__
    for method in ("begin", "decide"):
        has = callable(getattr(candidate, method, None))
        require(has, f"must have a method {method}", f"a {kind} without")
    for key, wanted, rule in (
        ("direction", Direction, "direction must be a Direction"),
        ("saturated", bool, "saturated must be true or false"),
    ):
        value = attempt(f"must have {key}", getattr, candidate, key, None)
        require(isinstance(value, wanted), rule, repr(value))
    memory = attempt("begin() must return a memory", candidate.begin)
    rule = "decide(knowledge, memory) must return (Intent, memory)"
    for knowledge in trial_knowledge():
        one, other = (
            attempt(rule, candidate.decide, knowledge, memory)
            for _ in range(2)
        )
        for each in (one, other):
            pair = isinstance(each, tuple) and len(each) == 2
            require(
                pair and isinstance(each[0], Intent),
                "decide must return (Intent, memory)",
                repr(each),
            )
        require(
            one[0] == other[0],
            "the same knowledge and memory must give the same intent",
            f"{one[0]} and then {other[0]}",
        )
        memory = one[1]
