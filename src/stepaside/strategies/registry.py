"""Strategies by name, and from files that anybody may write."""

import re
import sys
from collections.abc import Callable, Mapping
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

from ..errors import ConfigurationError
from .evasion import Evasion
from .pursuit import Pursuit
from .strategy import Strategy
from .trial import try_strategy
from .walk import Stand, Walk

STRATEGIES: Mapping[str, Callable[[Evasion], Strategy]] = {
    "evasion": lambda evasion: evasion,
    "pursuit": lambda evasion: Pursuit(),
    "stand": lambda evasion: Stand(),
    "walk": lambda evasion: Walk(),
}
"""Makes a strategy of each name, given how an evader of the paper evades."""

_IN_FILE = re.compile(r"(?P<file>.+\.py):(?P<name>[^:]*)", re.DOTALL)


def check_strategy_name(name: str, what: str = "strategy") -> None:
    """Refuse what names no strategy, without opening a file.

    Args:
        name: One of :data:`STRATEGIES`, or FILE.py:NAME.
        what: What it is the name of, for the message.

    Raises:
        ConfigurationError: If it is neither.
    """
    found = _IN_FILE.fullmatch(name)
    if name not in STRATEGIES and not (found and found["name"].isidentifier()):
        raise ConfigurationError(
            f"{what} must be one of {', '.join(STRATEGIES)} or FILE.py:NAME, "
            f"got {name!r}"
        )


def load_strategy(name: str, evasion: Evasion | None = None) -> Strategy:
    """Find a strategy.

    Args:
        name: One of :data:`STRATEGIES`, or FILE.py:NAME; there NAME is a
            strategy, or a class or function that makes one when it is
            called with nothing. The file is run.
        evasion: How an evader of the paper evades; by default as there.

    Returns:
        The strategy; that of a file has answered a few questions.

    Raises:
        ConfigurationError: If there is none, or it is no strategy.
    """
    check_strategy_name(name)
    found = _IN_FILE.fullmatch(name)
    if found is None:
        return STRATEGIES[name](evasion or Evasion())
    made = _made(found["file"], found["name"])
    try_strategy(made, name)
    strategy: Strategy = made
    return strategy


def absolute_name(name: str) -> str:
    """Name that means the same in every folder."""
    found = _IN_FILE.fullmatch(name)
    if name in STRATEGIES or found is None:
        return name
    file = Path(found["file"]).expanduser().resolve()
    return f"{file}:{found['name']}"


def _made(path: str, name: str) -> Any:
    """What a name in a file stands for, made if it has to be."""
    file = Path(path).expanduser()
    if not file.is_file():
        raise ConfigurationError(
            f"strategy {path}:{name}: there is no file {path}"
        )
    module = f"stepaside_strategy_{file.stem}"
    spec = spec_from_file_location(module, file)
    assert spec is not None and spec.loader is not None
    loaded = module_from_spec(spec)
    before = sys.modules.get(module)
    sys.modules[module] = loaded  # where dataclasses look for their module
    try:
        spec.loader.exec_module(loaded)
    except (Exception, SystemExit) as error:
        if before is None:
            del sys.modules[module]
        else:
            sys.modules[module] = before
        raise ConfigurationError(
            f"strategy {path}:{name}: the file does not run: "
            f"{type(error).__name__}: {error}"
        ) from error
    if not hasattr(loaded, name):
        there = sorted(n for n in vars(loaded) if not n.startswith("_"))
        raise ConfigurationError(
            f"strategy {path}:{name}: the file has no {name}, "
            f"but {', '.join(there) or 'nothing'}"
        )
    thing = getattr(loaded, name)
    if not isinstance(thing, type) and hasattr(thing, "decide"):
        return thing
    if not callable(thing):
        raise ConfigurationError(
            f"strategy {path}:{name}: must be a strategy, or a class or "
            f"function that makes one, got {_brief(thing)}"
        )
    try:
        return thing()
    except Exception as error:
        raise ConfigurationError(
            f"strategy {path}:{name}: {name}() must make a strategy, got "
            f"{type(error).__name__}: {error}"
        ) from error


def _brief(thing: Any) -> str:
    """A thing in one line of moderate length."""
    text = " ".join(repr(thing).split())
    return text if len(text) <= 60 else text[:57] + "..."
