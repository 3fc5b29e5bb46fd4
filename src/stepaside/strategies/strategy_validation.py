"""Asking an unknown strategy a few questions before it plays."""

from collections.abc import Iterator
from math import pi
from typing import Any

from ..core.errors import ConfigurationError
from ..planning import Direction
from .foreign_code import FAILURES
from .knowledge import Intent, Knowledge, Limits

LIMITS = Limits(0.1, 0.2, 0.04, 0.547)


def questions() -> Iterator[Knowledge]:
    """What a walker may come to know, from the first sighting on."""
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


def try_strategy(candidate: Any, name: str) -> None:
    """Refuse what does not answer as a strategy does.

    Args:
        candidate: What may be a strategy.
        name: What it is called, for messages.

    Raises:
        ConfigurationError: If it lacks something, fails, answers something
            else, or answers the same question in two ways.
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
            "direction and saturated must be there",
            f"{type(error).__name__}: {error}",
        ) from error
    if not isinstance(direction, Direction):
        raise refuse("direction must be a Direction", repr(direction))
    if not isinstance(saturated, bool):
        raise refuse("saturated must be true or false", repr(saturated))

    def asked(knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        try:
            answer = candidate.decide(knowledge, memory)
        except FAILURES as error:
            raise refuse(
                "decide(knowledge, memory) must answer",
                f"{type(error).__name__}: {error}",
            ) from error
        if not (
            isinstance(answer, tuple)
            and len(answer) == 2
            and isinstance(answer[0], Intent)
        ):
            raise refuse("decide must return (Intent, memory)", repr(answer))
        return answer

    try:
        memory = candidate.begin()
    except FAILURES as error:
        raise refuse(
            "begin() must give a memory", f"{type(error).__name__}: {error}"
        ) from error
    for knowledge in questions():
        intent, after = asked(knowledge, memory)
        again, _ = asked(knowledge, memory)
        if again != intent:
            raise refuse(
                "the same knowledge and memory must have the same answer",
                f"{intent} and then {again}",
            )
        memory = after
