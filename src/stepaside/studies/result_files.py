"""Files of measured results: what was found, how, and of which code.

A result is one JSON object. Whoever measures writes it whole; whoever makes
tables and figures only reads it.
"""

import json
import shlex
import sys
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from ..core.atomic_output import writing
from ..core.errors import ConfigurationError
from .code_version import LIBRARIES, PHYSICS, code_version, library_versions

# What every result names, before what was found.
HEADER = ("command", "rooms", "version", "libraries", "settings")
DIGITS = 6  # significant digits that are kept of a number


def header(
    settings: Mapping[str, Any],
    *,
    rooms: tuple[str, ...] = PHYSICS,
    libraries: Sequence[str] = LIBRARIES,
    command: str | None = None,
) -> dict[str, Any]:
    """Where a result comes from: what every file of results begins with.

    Args:
        settings: What was asked for: seeds, durations, numbers of runs.
        rooms: Rooms of the package that the result depends on.
        libraries: Packages that it depends on.
        command: That makes it again; the one that runs by default.

    Returns:
        The entries of ``HEADER``.
    """
    return {
        "command": running_command() if command is None else command,
        "rooms": list(rooms),
        "version": code_version(rooms),
        "libraries": library_versions(libraries),
        "settings": dict(settings),
    }


def running_command(arguments: Sequence[str] | None = None) -> str:
    """Command line of this process, as one types it in the repository.

    Args:
        arguments: Program and its arguments; those of this process by
            default. A program that is no Python file stands by its name,
            and files below the working folder by their way from there.
    """
    program, *rest = sys.argv if arguments is None else arguments
    if Path(program).parts[-2:] == ("stepaside", "__main__.py"):
        program = "stepaside"  # python -m stepaside
    words = (
        ["python", _relative(program)]
        if program.endswith(".py")
        else [Path(program).name]
    )
    return shlex.join([*words, *map(_relative, rest)])


def write_result(
    file: Path, head: Mapping[str, Any], **found: Any
) -> dict[str, Any]:
    """Write a result, whole or not at all.

    Numbers keep six significant digits; a number that is none is refused.

    Args:
        file: Where to; its folder is made.
        head: Of :func:`header`.
        found: What was measured, ready for JSON.

    Returns:
        What the file holds.

    Raises:
        ConfigurationError: If the head is not one, or a value not finite.
        OutputError: If it cannot be written.
    """
    missing = [name for name in HEADER if name not in head]
    if missing:
        raise ConfigurationError(
            f"a result must name {', '.join(HEADER)}, "
            f"{file.name} lacks {', '.join(missing)}"
        )
    result: dict[str, Any] = _rounded({**head, **found}, file.name)
    text = json.dumps(result, indent=1, ensure_ascii=False)
    with writing(file) as draft:
        draft.write_text(text + "\n", encoding="utf-8")
    return result


def read_result(file: Path) -> dict[str, Any]:
    """Read a result.

    Raises:
        ConfigurationError: If it is not there, or is none.
    """
    try:
        result = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ConfigurationError(f"no result {file.name}") from None
    except ValueError as error:
        raise ConfigurationError(
            f"{file.name} is no result: {error}"
        ) from error
    missing = [name for name in HEADER if name not in result]
    if missing:
        raise ConfigurationError(
            f"{file.name} is no result, it lacks {', '.join(missing)}"
        )
    return dict(result)


def is_current(result: Mapping[str, Any]) -> bool:
    """Whether the code that a result depends on is what made it."""
    try:
        return bool(result["version"] == code_version(tuple(result["rooms"])))
    except FileNotFoundError:  # of rooms that are no more
        return False


def _relative(word: str) -> str:
    """A path below the working folder by its way from there."""
    path = Path(word)
    if not path.is_absolute():
        return word
    here = Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else word


def _rounded(value: Any, where: str) -> Any:
    """Numbers of a tree to a few significant digits."""
    if isinstance(value, Mapping):
        return {k: _rounded(v, f"{where}.{k}") for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(v, f"{where}.{i}") for i, v in enumerate(value)]
    if isinstance(value, float):
        if not isfinite(value):
            raise ConfigurationError(f"{where} must be finite, got {value}")
        return float(f"{value:.{DIGITS}g}")
    return value
