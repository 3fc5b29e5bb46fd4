"""Validation of a strategy by trial decisions."""

from collections.abc import Iterator
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
        time, distance = 0.5 * (i + 1), 1.5 - 0.4 * i
        yield Knowledge(
            time,
            bearing,
            distance,
            LIMITS,
            0.1,
            0.2,
            0.05,
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

    def refuse(rule: str, got: object) -> ConfigurationError:
        text = " ".join(str(got).split())
        return ConfigurationError(f"strategy {name}: {rule}, got {text}")

    kind = type(candidate).__name__
    for method in ("begin", "decide"):
        if not callable(getattr(candidate, method, None)):
            raise refuse(f"must have a method {method}", f"a {kind} without")
    try:
        direction = getattr(candidate, "direction", None)
        saturated = getattr(candidate, "saturated", None)
    except FAILURES as error:
        raise refuse(
            "must have direction and saturated",
            f"{type(error).__name__}: {error}",
        ) from error
    if not isinstance(direction, Direction):
        raise refuse("direction must be a Direction", repr(direction))
    if not isinstance(saturated, bool):
        raise refuse("saturated must be true or false", repr(saturated))

    def decide(knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        try:
            result = candidate.decide(knowledge, memory)
        except FAILURES as error:
            raise refuse(
                "decide(knowledge, memory) must return (Intent, memory)",
                f"{type(error).__name__}: {error}",
            ) from error
        if not (
            isinstance(result, tuple)
            and len(result) == 2
            and isinstance(result[0], Intent)
        ):
            raise refuse("decide must return (Intent, memory)", repr(result))
        return result

    try:
        memory = candidate.begin()
    except FAILURES as error:
        raise refuse(
            "begin() must return a memory", f"{type(error).__name__}: {error}"
        ) from error
    for knowledge in trial_knowledge():
        intent, after = decide(knowledge, memory)
        again, _ = decide(knowledge, memory)
        if again != intent:
            raise refuse(
                "the same knowledge and memory must give the same intent",
                f"{intent} and then {again}",
            )
        memory = after
