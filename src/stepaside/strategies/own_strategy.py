"""Strategies of users: made from their files, and tried."""

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass, replace
from inspect import signature
from math import pi
from pathlib import Path
from types import NoneType
from typing import Any, get_args

from ..core.errors import (
    FAILURES,
    ConfigurationError,
    StrategyError,
    nearest_hint,
    shown,
)
from ..core.setting import EntryReader
from ..core.user_file import load_user_file
from ..planning import Direction
from .decision_maker import evaluate_strategy
from .knowledge import Knowledge, Limits
from .shield import ShieldedStrategy

SCALARS = {float, int, bool, NoneType}  # annotations that are checked
LIMITS = Limits(0.1, 0.2, 0.04, 0.547)  # of trial decisions


def create_strategy(
    file: Path, name: str, given: Mapping[str, Any], text: str
) -> Any:
    """Return the strategy that a name in a file denotes, created if needed.

    Its text is for messages.
    """
    where = f"strategy {text}"
    loaded = load_user_file(str(file), where)
    thing = getattr(loaded, name, None)
    if thing is None:
        own = [
            key
            for key, each in vars(loaded).items()
            if getattr(each, "__module__", None) == loaded.__name__
        ]
        raise ConfigurationError(
            f"{where}: the file has no {name}, but "
            f"{', '.join(sorted(own)) or 'no strategy'}"
        )
    is_made = not isinstance(thing, type) and hasattr(thing, "decide")
    if is_made and not given:
        return thing
    if not (callable(thing) or (is_made and is_dataclass(thing))):
        raise ConfigurationError(
            f"{where}: must be a strategy, or a class or function that makes "
            f"one, got {shown(thing)}"
        )
    _check_arguments(thing, given, f"{where}: {name}")
    try:
        return replace(thing, **given) if is_made else thing(**given)
    except FAILURES as error:
        listed = ", ".join(f"{key}={value!r}" for key, value in given.items())
        raise ConfigurationError(
            f"{where}: {name}({listed}) must make a strategy, got "
            f"{type(error).__name__}: {error}"
        ) from error


def _check_arguments(thing: Any, given: Mapping[str, Any], what: str) -> None:
    """Check names, and values where a number or truth value is annotated."""
    made = thing if callable(thing) else type(thing)
    try:
        known = signature(made, eval_str=True).parameters
    except ValueError:  # of code without a signature
        return
    except FAILURES:  # a type that is imported for checks alone
        known = signature(made).parameters
    reader = EntryReader()
    if any(each.kind is each.VAR_KEYWORD for each in known.values()):
        return
    for key, value in given.items():
        if key not in known:
            raise ConfigurationError(
                f"{what} must have arguments of "
                f"{', '.join(known) or 'none'}, got {key!r}"
                f"{nearest_hint(key, known)}"
            )
        kind = known[key].annotation
        if {*(get_args(kind) or (kind,))} <= SCALARS:
            reader.read(value, kind, key)
    if reader.problems:
        raise ConfigurationError(f"{what}: {reader.text}")


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
    """Check by trial decisions that an object behaves as a strategy.

    Within a shield, whose decisions need a table, that is its strategy.
    """
    if isinstance(candidate, ShieldedStrategy):
        candidate = candidate.strategy

    def refuse(rule: str, got: object) -> ConfigurationError:
        text = " ".join(str(got).split())
        return ConfigurationError(f"strategy {name}: {rule}, got {text}")

    for method in ("begin", "decide"):
        if not callable(getattr(candidate, method, None)):
            got = f"a {type(candidate).__name__} without"
            raise refuse(f"must have a method {method}", got)
    rule = ""
    try:
        for key, kind in (("direction", Direction), ("saturated", bool)):
            rule = f"{key} must be a {kind.__name__}"
            value = getattr(candidate, key, None)
            if not isinstance(value, kind):
                raise StrategyError(repr(value))
        rule = "begin() must return a memory"
        memory = candidate.begin()
        rule = "decide(knowledge, memory) must return (Intent, memory)"
        for knowledge in trial_knowledge():
            one, memory_then = evaluate_strategy(candidate, knowledge, memory)
            other, _ = evaluate_strategy(candidate, knowledge, memory)
            if one != other:
                rule = (
                    "the same knowledge and memory must give the same intent"
                )
                raise StrategyError(f"{one} and then {other}")
            memory = memory_then
    except StrategyError as error:
        raise refuse(rule, error) from error
    except FAILURES as error:
        raise refuse(rule, f"{type(error).__name__}: {error}") from error
