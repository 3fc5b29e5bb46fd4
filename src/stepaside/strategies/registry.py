"""Registry of strategies: by name, and from user files.

The module of a strategy is imported when it is made.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from math import inf
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from .. import strategies
from ..core.errors import ConfigurationError
from ..core.setting import ranges_of
from ..core.user_file import (
    FAILURES,
    FILE_AND_NAME,
    load_user_file,
    shown_briefly,
)
from .evasion import Evasion
from .strategy import Strategy
from .strategy_validation import validate_strategy


def _matador() -> Strategy:
    """Return the dash evader against a person who chases the robot.

    A chaser comes back: there is nothing to gain by standing, and after a
    feint the opposite direction is the better one.
    """
    from .dash_evasion import CHASER_RADIUS, DashEvasion

    return DashEvasion(
        CHASER_RADIUS,
        enough=inf,
        clearance=1.0,
        contact_time=6.0,
        effort=0.0,
        change=0.1,
    )


STRATEGIES: Mapping[str, Callable[[Evasion], Strategy]] = {
    "evasion": lambda evasion: evasion,
    "look-ahead": lambda evasion: strategies.LookAhead(),
    "robust": lambda evasion: strategies.RobustEvasion(),
    "optimal": lambda evasion: strategies.OptimalEvasion(),
    "step-aside": lambda evasion: strategies.DashEvasion(),
    "matador": lambda evasion: _matador(),
    "wary": lambda evasion: strategies.WaryEvasion(),
    "pursuit": lambda evasion: strategies.Pursuit(),
    "sharp": lambda evasion: strategies.Pursuit(gain_ratio=inf),
    "herding": lambda evasion: strategies.HerdingPursuit(),
    "lead": lambda evasion: strategies.LeadPursuit(),
    "noisy": lambda evasion: strategies.NoisyPursuit(),
    "stop-and-wait": lambda evasion: strategies.WaitingPursuit(),
    "optimal-pursuit": lambda evasion: strategies.OptimalPursuit(),
    "cyclic": lambda evasion: strategies.CyclicPursuit(),
    "assigned": lambda evasion: strategies.AssignedPursuit(),
    "pincer": lambda evasion: strategies.Pincer(),
    "team-evasion": lambda evasion: strategies.TeamEvasion(),
    "goal": lambda evasion: strategies.GoalWalk(),
    "stand": lambda evasion: strategies.StandStill(),
    "walk": lambda evasion: strategies.Walk(),
}
"""Factory of each named strategy, given the settings of the paper's evader."""

OF_EVASION = ("evasion",)  # strategies that use them
_OBJECT = re.compile(r"object [\w.<>]+\(.*\)", re.DOTALL)
_WITH_GAIN = re.compile(r"pursuit-x(?P<ratio>\d+(?:\.\d*)?)", re.ASCII)
"""The paper's pursuer with another gain than its gait's."""
_NETWORK = re.compile(r"(?P<file>.+\.onnx)", re.DOTALL)
"""A learned strategy."""


def describe_strategy(strategy: str | Strategy) -> str:
    """Return the text that records a strategy: its name, or its class.

    Args:
        strategy: A name, which is returned, or a strategy, whose class and
            plain values are.
    """
    if isinstance(strategy, str):
        return strategy
    kind = type(strategy)
    values: list[tuple[str, Any]] = (
        [
            (each.name, getattr(strategy, each.name))
            for each in fields(strategy)
        ]
        if is_dataclass(strategy)
        else []
    )
    plain = ", ".join(
        f"{name}={value!r}"
        for name, value in values
        if isinstance(value, bool | int | float | str | None)
    )
    return f"object {kind.__module__}.{kind.__qualname__}({plain})"


def is_described(name: str) -> bool:
    """Return whether a name only records the class of a strategy."""
    return _OBJECT.fullmatch(name) is not None


def check_strategy_name(
    name: str, what: str = "strategy", *, recorded: bool = False
) -> None:
    """Check the name of a strategy, without opening a file.

    Args:
        name: One of :data:`STRATEGIES`, pursuit-xRATIO (the pursuer of the
            paper with RATIO times the gain of its gait), FILE.py:NAME, or
            FILE.onnx.
        what: Name of the setting, for the message.
        recorded: Whether text of :func:`describe_strategy` is valid, too.

    Raises:
        ConfigurationError: If the name is invalid.
    """
    if recorded and is_described(name):
        return
    if name in STRATEGIES:
        return
    if with_gain := _WITH_GAIN.fullmatch(name):
        ranges_of(strategies.Pursuit)["gain_ratio"].check(
            float(with_gain["ratio"]), f"RATIO of {what} pursuit-xRATIO"
        )
        return
    if _NETWORK.fullmatch(name):
        return
    found = FILE_AND_NAME.fullmatch(name)
    if not (found and found["name"].isidentifier()):
        raise ConfigurationError(
            f"{what} must be one of {', '.join(STRATEGIES)}, "
            f"pursuit-xRATIO, FILE.py:NAME or FILE.onnx, got {name!r}"
        )


def load_strategy(
    name: str | Strategy, evasion: Evasion | None = None
) -> Strategy:
    """Load a strategy by name, or check a strategy object.

    Args:
        name: One of :data:`STRATEGIES`, pursuit-xRATIO, FILE.py:NAME, or
            FILE.onnx, a learned strategy. In a Python file NAME is a
            strategy, or a class or function without required arguments that
            returns one. The file is executed. A strategy object is returned
            as it is.
        evasion: Settings of the paper's evader; its defaults if not given.

    Returns:
        The strategy; user code has passed a few trial decisions.

    Raises:
        ConfigurationError: If there is no such strategy, or it is invalid.
    """
    if not isinstance(name, str):
        validate_strategy(name, describe_strategy(name))
        return name
    if is_described(name):
        raise ConfigurationError(
            f"strategy must be a name or FILE.py:NAME, got {name!r}: it was "
            "given as a Python object, which a configuration cannot make "
            "again; give its FILE.py:NAME, or the object from Python"
        )
    check_strategy_name(name)
    if with_gain := _WITH_GAIN.fullmatch(name):
        return strategies.Pursuit(gain_ratio=float(with_gain["ratio"]))
    if _NETWORK.fullmatch(name):
        from .learned import load_learned_strategy

        learned = load_learned_strategy(name)
        validate_strategy(learned, name)
        return learned
    found = FILE_AND_NAME.fullmatch(name)
    if found is None:
        return STRATEGIES[name](evasion or Evasion())
    made = _create(found["file"], found["name"])
    validate_strategy(made, name)
    strategy: Strategy = made
    return strategy


def absolute_name(name: str) -> str:
    """Return the name with an absolute file path."""
    file = file_of(name)
    if file is None:
        return name
    found = FILE_AND_NAME.fullmatch(name)
    path = str(file.resolve())
    return f"{path}:{found['name']}" if found else path


def file_of(name: str) -> Path | None:
    """Return the file of a strategy; None for one of :data:`STRATEGIES`."""
    found = FILE_AND_NAME.fullmatch(name) or _NETWORK.fullmatch(name)
    return None if found is None else Path(found["file"]).expanduser()


def _create(path: str, name: str) -> Any:
    """Return the strategy that a name in a file denotes, created if needed."""
    where = f"strategy {path}:{name}"
    loaded = load_user_file(path, where)
    if not hasattr(loaded, name):
        available = ", ".join(_strategies_in(loaded)) or "no strategy"
        raise ConfigurationError(
            f"{where}: the file has no {name}, but {available}"
        )
    thing = getattr(loaded, name)
    if not isinstance(thing, type) and hasattr(thing, "decide"):
        return thing
    if not callable(thing):
        raise ConfigurationError(
            f"{where}: must be a strategy, or a class or function that makes "
            f"one, got {shown_briefly(thing)}"
        )
    try:
        return thing()
    except FAILURES as error:
        raise ConfigurationError(
            f"{where}: {name}() must make a strategy, got "
            f"{type(error).__name__}: {error}"
        ) from error


def _strategies_in(loaded: ModuleType) -> list[str]:
    """Return the names of possible strategies that a file defines.

    Functions are included: whether one returns a strategy shows only when it
    is called.
    """
    found = []
    for name, thing in vars(loaded).items():
        own = getattr(thing, "__module__", None) == loaded.__name__
        decides = hasattr(thing, "decide")
        if isinstance(thing, type):
            fits = own and decides
        else:
            fits = decides or (own and isinstance(thing, FunctionType))
        if fits and not name.startswith("_"):
            found.append(name)
    return sorted(found)
