"""Strategies by name with arguments, and from files of users.

A name is written as a call: ``pursuit``, ``pursuit(gain=2)``,
``evasion(angle=45deg)``, ``FILE.py:NAME(near=1.2)``. The module of a strategy
is imported when the strategy is made.
"""

import re
from ast import literal_eval
from collections.abc import Mapping
from dataclasses import fields, replace
from functools import lru_cache
from math import inf, radians
from pathlib import Path
from typing import Any, NamedTuple

from .. import strategies
from ..core.errors import ConfigurationError, StepAsideError, nearest_hint
from ..planning import Direction
from .evasion import Evasion
from .strategy import Strategy

STRATEGIES: Mapping[str, tuple[str, Mapping[str, Any]]] = {
    "evasion": ("Evasion", {}),
    "look-ahead": ("LookAhead", {}),
    "robust": ("RobustEvasion", {}),
    "optimal": ("LookAhead", {"obstacles": False}),
    "step-aside": ("DashEvasion", {}),
    "matador": (
        "DashEvasion",
        {
            "turning_radius": 2.5,
            "enough": inf,
            "clearance": 1.0,
            "contact_time": 6.0,
            # A chaser comes back: there is nothing to gain by standing, and
            # after a feint the opposite direction is the better one.
            "effort": 0.0,
            "change": 0.1,
        },
    ),
    "wary": (
        "DashEvasion",
        {
            "turning_radius": 2.5,
            "clearance": 1.0,
            "contact_time": 3.5,
            "doubt": 0.5,
            "alertness": 1.5,
        },
    ),
    "pursuit": ("Pursuit", {}),
    "sharp": ("Pursuit", {"gain": inf}),
    "herding": ("Pursuit", {"pull": 1.0}),
    "lead": ("Pursuit", {"lead": 0.5}),
    "noisy": ("Pursuit", {"gain": 2.0, "noise": 0.5}),
    "stop-and-wait": ("Pursuit", {"waiting": 5.0}),
    "cyclic": ("CyclicPursuit", {}),
    "assigned": ("AssignedPursuit", {}),
    "pincer": ("Pincer", {}),
    "team-evasion": ("TeamEvasion", {}),
    "goal": ("GoalWalk", {}),
    "stand": ("StandStill", {}),
    "walk": ("Walk", {}),
    "walk-backward": ("Walk", {"direction": Direction.BACKWARD}),
}
"""Class of each named strategy, and its arguments."""

OF_EVASION = ("evasion",)  # strategies that use settings of an Evasion
OBJECT = "object "  # begins the text that records a strategy object
_CALL = re.compile(
    r"(?P<name>(?P<file>.+\.(?:py(?=:)|onnx))(?::(?P<own>\w+))?|[^():]+)"
    r"(?:\((?P<arguments>.*)\))?",
    re.DOTALL,
)
_COMMA = re.compile(r",(?![^(\[]*[)\]])")  # not one within a tuple
_WORDS = {"inf": inf, "true": True, "false": False, "none": None}


class _Named(NamedTuple):
    """Name of a strategy, its arguments, and NAME of FILE.py:NAME."""

    name: str
    arguments: dict[str, Any]
    file: Path | None
    own: str | None


def describe_strategy(strategy: Strategy) -> str:
    """Return the text that records a strategy object: its class."""
    return OBJECT + type(strategy).__qualname__


def check_strategy_name(
    name: str, what: str = "strategy", *, recorded: bool = False
) -> None:
    """Check a name with its arguments, without opening a file.

    Messages name the setting. Recorded text is that of
    :func:`describe_strategy`, too.
    """
    if recorded and name.startswith(OBJECT):
        return
    named = _parse(name, what)
    if named.arguments and named.file is None:
        _make(name, Evasion(), what)


def load_strategy(
    name: str | Strategy, evasion: Evasion | None = None
) -> Strategy:
    """Load a strategy by name, or check a strategy object.

    Args:
        name: One of :data:`STRATEGIES` or FILE.py:NAME, with arguments or
            without, or FILE.onnx, a learned strategy. In a Python file, which
            is executed, NAME is a strategy, or a class or function that
            returns one, given the arguments. User code makes a few trial
            decisions.
        evasion: Settings of the paper's evader that arguments replace.

    Raises:
        ConfigurationError: If there is no such strategy, or it is invalid.
    """
    if not isinstance(name, str):
        from .own_strategy import validate_strategy

        validate_strategy(name, describe_strategy(name))
        return name
    named = _parse(name)
    if named.file is None:
        return _make(name, evasion or Evasion())
    from .own_strategy import create_strategy, validate_strategy

    if named.own is None:
        from .learned import load_learned_strategy

        made: Any = load_learned_strategy(named.file)
    else:
        made = create_strategy(
            *(named.file, named.own, named.arguments, named.name)
        )
    validate_strategy(made, name)
    strategy: Strategy = made
    return strategy


def file_of(name: str) -> Path | None:
    """Return the file that a name denotes; None for any other text."""
    found = _CALL.fullmatch(name)
    file = found and found["file"]
    return Path(file).expanduser() if file else None


@lru_cache(256)
def _parse(text: str, what: str = "strategy") -> _Named:
    """Return the parts of the name of a strategy."""
    if text.startswith(OBJECT):
        raise ConfigurationError(
            f"{what} must be a name or FILE.py:NAME, got {text!r}: it was "
            "given as a Python object, which a configuration cannot make "
            "again; give its FILE.py:NAME, or the object from Python"
        )
    found = _CALL.fullmatch(text)
    name = found["name"].strip() if found else text
    own, file = found and found["own"], file_of(text)
    arguments: dict[str, Any] = {}
    listed = (found and found["arguments"]) or ""
    for each in filter(str.strip, _COMMA.split(listed)):
        key, is_pair, value = (part.strip() for part in each.partition("="))
        if not (is_pair and key.isidentifier() and value):
            raise ConfigurationError(
                f"{what} {name} must have arguments like gain=2, got {each!r}"
            )
        arguments[key] = _value(value)
    is_file = file and own is None and name.endswith(".onnx")
    if is_file and arguments:
        raise ConfigurationError(
            f"{what} {name} must have no arguments, got {', '.join(arguments)}"
        )
    if name in STRATEGIES or is_file or (own and own.isidentifier()):
        return _Named(name, arguments, file, own)
    raise ConfigurationError(
        f"{what} must be FILE.py:NAME, with NAME in the file, got {text!r:.80}"
        if text.endswith(".py")
        else f"{what} must be one of {', '.join(STRATEGIES)}, FILE.py:NAME or "
        f"FILE.onnx, got {text!r:.80}{nearest_hint(name, STRATEGIES)}"
    )


def _value(text: str) -> Any:
    """Return the value of an argument: a number, a word, a tuple or text."""
    if text.lower() in _WORDS:
        return _WORDS[text.lower()]
    try:
        if text.endswith("deg"):
            return radians(float(text.removesuffix("deg")))
        return literal_eval(text)
    except (ValueError, SyntaxError):
        return text


@lru_cache(256)
def _make(text: str, evasion: Evasion, what: str = "strategy") -> Strategy:
    """Return a strategy of the table."""
    named = _parse(text, what)
    kind, values = STRATEGIES[named.name]
    made = getattr(strategies, kind)
    known = [each.name for each in fields(made)]
    for key in named.arguments:
        if key not in known:
            raise ConfigurationError(
                f"{what} {named.name} must have arguments of "
                f"{', '.join(known) or 'none'}, got {key!r}"
                f"{nearest_hint(key, known)}"
            )
    try:
        if named.name in OF_EVASION:
            return replace(evasion, **named.arguments)
        strategy: Strategy = made(**{**values, **named.arguments})
    except (StepAsideError, TypeError) as error:
        raise ConfigurationError(f"{what} {named.name}: {error}") from error
    return strategy
