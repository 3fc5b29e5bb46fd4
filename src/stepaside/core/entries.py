"""Files of entries: TOML and JSON, read into dataclasses and written."""

import errno
import json
import tomllib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any, TypeVar

from .errors import ConfigurationError, StepAsideError
from .setting import EntryReader

S = TypeVar("S")
ERROR = ConfigurationError
MAX_CHARACTERS = 2**20  # of a file


def check_regular(path: Path) -> None:
    """Raise OSError for a pipe or device, whose reading may never end."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(errno.EINVAL, "not a regular file", str(path))


def load_entries(
    path: Path, error: type[StepAsideError] = ERROR
) -> dict[str, Any]:
    """Read the nested entries of a TOML file, or of one with suffix .json."""
    read = json.loads if path.suffix.lower() == ".json" else tomllib.loads
    try:
        check_regular(path)
        with path.open("rb") as file:
            text = file.read(MAX_CHARACTERS + 1).decode("utf-8-sig")
        if len(text) > MAX_CHARACTERS:
            raise ValueError(f"more than {MAX_CHARACTERS} characters")
        entries = read(text)
    except RecursionError as cause:
        raise error(f"{path} is nested too deep") from cause
    except (OSError, UnicodeDecodeError) as cause:
        reason = getattr(cause, "strerror", None) or str(cause)
        raise error(f"{path}: {reason.lower()}") from cause
    except ValueError as cause:  # or an integer of too many digits
        raise error(f"{path}: {cause}") from cause
    if not isinstance(entries, dict):
        raise error(f"{path} must hold one object, got {entries!r:.40}")
    return entries


def read_entries(
    kind: type[S],
    entries: Mapping[str, Any],
    source: str = "",
    *,
    base: S | None = None,
    ignoring: bool = False,
    error: type[StepAsideError] = ERROR,
) -> S:
    """Turn nested entries into a dataclass.

    Types, ranges, units and names are those of its fields; see
    :func:`~.setting.setting`. The source is for messages, and the base gives
    what entries omit, in sections as well.
    """
    reader = EntryReader(ignoring=ignoring)
    made: S = reader.read_table(entries, kind, "", base)
    if reader.problems:
        raise error(f"{source}: {reader.text}" if source else reader.text)
    return made


def to_entries(value: Any) -> Any:
    """Return a value as nested entries, without those that are None."""
    if is_dataclass(value) and not isinstance(value, type):
        value = {f.name: getattr(value, f.name) for f in fields(value)}
    elif hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, Mapping):
        return {
            name: to_entries(each)
            for name, each in value.items()
            if each is not None
        }
    if isinstance(value, list | tuple):
        return [to_entries(each) for each in value]
    if isinstance(value, Path):
        return str(value)
    return value.value if isinstance(value, Enum) else value
