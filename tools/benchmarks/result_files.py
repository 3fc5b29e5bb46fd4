"""Result files: measurements with their command, version and settings.

A result is one JSON object. Measuring programs write it; tables and figures
are made from it.
"""

import json
import shlex
import sys
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from stepaside.core.atomic_output import atomic_draft
from stepaside.core.errors import ConfigurationError
from stepaside.studies.results_version import RESULTS, library_versions

DIGITS = 6  # significant digits of numbers in a result


def header(
    settings: Mapping[str, Any], command: str | None = None
) -> dict[str, Any]:
    """Return the header of a result; the command is by default this one."""
    return {
        "command": command or shlex.join(["python", *map(_near, sys.argv)]),
        "results": RESULTS,
        "libraries": library_versions(),
        "settings": dict(settings),
    }


def write_result(
    file: Path, head: Mapping[str, Any], **found: Any
) -> dict[str, Any]:
    """Write a result atomically, its numbers to six significant digits.

    NaN and inf are refused.
    """
    result: dict[str, Any] = _rounded({**head, **found}, file.name)
    text = json.dumps(result, indent=1, ensure_ascii=False)
    with atomic_draft(file) as draft:
        # Paths may have bytes that are not UTF-8.
        draft.write_text(text + "\n", "utf-8", "backslashreplace")
    return result


def read_result(file: Path) -> dict[str, Any]:
    """Read a result."""
    return dict(json.loads(file.read_text(encoding="utf-8")))


def _near(word: str) -> str:
    """Make an absolute path below the working folder relative."""
    path = Path(word)
    return str(
        path.relative_to(Path.cwd())
        if path.is_relative_to(Path.cwd())
        else word
    )


def _rounded(value: Any, where: str) -> Any:
    """Round all numbers of nested values to significant digits."""
    if isinstance(value, Mapping):
        return {k: _rounded(v, f"{where}.{k}") for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(v, f"{where}.{i}") for i, v in enumerate(value)]
    if isinstance(value, float):
        if not isfinite(value):
            raise ConfigurationError(f"{where} must be finite, got {value}")
        return float(f"{value:.{DIGITS}g}")
    return value
