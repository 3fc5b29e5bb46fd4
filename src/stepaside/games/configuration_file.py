"""Configuration files: settings read from and written to TOML."""

import tomllib
from collections.abc import Callable, Collection
from dataclasses import fields, is_dataclass
from enum import Enum
from math import isfinite
from pathlib import Path
from types import NoneType
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import dacite
import tomli_w

from ..arena import Room, room_from_entries, room_to_entries
from ..core.errors import (
    AnyPath,
    ConfigurationError,
    StepAsideError,
    as_path,
    shown,
)
from ..core.regular_files import check_regular
from .duel_settings import DuelSettings
from .game_settings import GameSettings, PlayerSettings
from .walk_settings import WalkSettings


def over(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Merge two nested tables; entries of ``above`` take precedence."""
    merged = below | above
    for key in below.keys() & above.keys():
        if isinstance(below[key], dict) and isinstance(above[key], dict):
            merged[key] = over(below[key], above[key])
    return merged


def with_tuples(kind: Any, entries: dict[str, Any]) -> dict[str, Any]:
    """Replace lists by tuples where the settings class has tuples."""
    changed = dict(entries)
    hints = get_type_hints(kind)
    for key in entries.keys() & hints.keys():
        value, hint = entries[key], hints[key]
        if isinstance(value, list) and get_origin(hint) is tuple:
            changed[key] = _with_inner_tuples(hint, value)
        elif isinstance(value, dict) and is_dataclass(hint):
            changed[key] = with_tuples(hint, value)
    return changed


def _with_inner_tuples(hint: Any, values: list[Any]) -> tuple[Any, ...]:
    """Return a list as a tuple, with tuples in its tables of settings."""
    kind = get_args(hint)[0]
    if not is_dataclass(kind):
        return tuple(values)
    return tuple(
        with_tuples(kind, value) if isinstance(value, dict) else value
        for value in values
    )


S = TypeVar("S")  # a frozen dataclass of settings

MAX_CHARACTERS = 2**20  # of a configuration file


def load_settings(
    kind: type[S],
    path: Path,
    *,
    aside: Collection[str] = (),
    base: S | None = None,
) -> S:
    """Read settings.

    Args:
        kind: Class of the settings.
        path: TOML file; entries that it omits keep their defaults.
        aside: Entries that are ignored, as they belong to other settings.
        base: Settings whose values are the defaults; by default those of
            the class.

    Returns:
        The settings.

    Raises:
        ConfigurationError: If the file is not TOML, or an entry is unknown,
            of the wrong type or out of its range.
    """
    entries = load_entries(path)
    return parse_settings(kind, entries, str(path), aside=aside, base=base)


def load_entries(path: Path) -> dict[str, Any]:
    """Read the nested entries of a TOML file.

    Raises:
        ConfigurationError: If the file cannot be read, or is not TOML.
    """
    try:
        check_regular(path)
        with path.open("rb") as file:
            text = file.read(MAX_CHARACTERS + 1).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path}: {error}") from error
    return read_entries(text, str(path))


def read_settings(
    kind: type[S], text: str, source: str, *, aside: Collection[str] = ()
) -> S:
    """Parse settings from TOML text.

    Args:
        kind: Class of the settings.
        text: TOML.
        source: Origin of the text, for messages.
        aside: As :func:`load_settings`.

    Raises:
        ConfigurationError: As :func:`load_settings`.
    """
    return parse_settings(
        kind, read_entries(text, source), source, aside=aside
    )


def read_entries(text: str, source: str) -> dict[str, Any]:
    """Parse TOML text into nested entries.

    Args:
        text: TOML.
        source: Origin of the text, for messages.

    Raises:
        ConfigurationError: If the text is not TOML, or too long.
    """
    if len(text) > MAX_CHARACTERS:
        raise ConfigurationError(
            f"{source} must have at most {MAX_CHARACTERS} characters"
        )
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        raise ConfigurationError(f"{source} is nested too deep") from error
    except ValueError as error:  # not TOML, or an integer of too many digits
        raise ConfigurationError(f"{source}: {error}") from error


def parse_settings(
    kind: type[S],
    entries: dict[str, Any],
    source: str,
    *,
    aside: Collection[str] = (),
    base: S | None = None,
) -> S:
    """Turn nested entries into settings.

    Args:
        kind: Class of the settings.
        entries: Sections and values.
        source: Where they come from, for messages.
        aside: As :func:`load_settings`.
        base: Likewise.

    Raises:
        ConfigurationError: As :func:`load_settings`.
    """
    own = {field.name for field in fields(kind)}  # type: ignore[arg-type]
    left = set(aside) - own
    entries = {key: v for key, v in entries.items() if key not in left}

    if base is not None:
        entries = over(open_entries(base), entries)
    entries = with_tuples(kind, entries)
    hooks: dict[type[Any], Callable[[Any], Any]]
    hooks = {float: _as_float, int: _as_int, Room: _as_room}
    config = dacite.Config(strict=True, type_hooks=hooks, cast=[Enum])
    try:
        return dacite.from_dict(kind, entries, config)
    except dacite.UnexpectedDataError as error:
        unknown = ", ".join(sorted(error.keys))
        raise ConfigurationError(
            f"{source}: unknown entry {unknown}"
        ) from error
    except dacite.MissingValueError as error:
        raise ConfigurationError(
            f"{source}: missing entry {error.field_path}"
        ) from error
    except dacite.WrongTypeError as error:
        raise ConfigurationError(
            f"{source}: {error.field_path} must be "
            f"{_type_name(error.field_type)}, got {shown(error.value)}"
        ) from error
    except StepAsideError:
        raise
    except (AttributeError, TypeError, ValueError) as error:
        # For example a table where a list is expected.
        raise ConfigurationError(
            f"{source}: an entry has the wrong type: {error}"
        ) from error


def load_configuration(path: AnyPath) -> DuelSettings:
    """Read the configuration of a duel; see :func:`load_settings`."""
    return load_settings(DuelSettings, as_path(path, "path"))


def dump_configuration(settings: Any) -> str:
    """Return the TOML text from which the same settings are read."""
    return tomli_w.dumps(settings_entries(settings))


def settings_entries(settings: Any) -> dict[str, Any]:
    """Return settings as the nested entries of a configuration file.

    What they leave open is resolved.
    """
    if isinstance(settings, DuelSettings | GameSettings | WalkSettings):
        settings = settings.resolved()
    return open_entries(settings)


def open_entries(settings: Any) -> dict[str, Any]:
    """Return settings as nested entries, without those that are open."""
    if isinstance(settings, DuelSettings | GameSettings | PlayerSettings):
        settings = settings.named()
    entries: dict[str, Any] = _plain(_unfolded(settings))
    return entries


def json_settings(settings: Any) -> dict[str, Any]:
    """Return settings for JSON; infinite values become text."""
    entries: dict[str, Any] = _spelled(settings_entries(settings))
    return entries


def _type_name(kind: Any) -> str:
    kinds = [one for one in get_args(kind) if one is not NoneType]
    if NoneType in get_args(kind) and len(kinds) == 1:
        return _type_name(kinds[0])
    if get_origin(kind) is Literal:
        return f"one of {', '.join(map(str, get_args(kind)))}"
    return f"a {getattr(kind, '__name__', kind)}"


def _spelled(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _spelled(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_spelled(entry) for entry in value]
    infinite = isinstance(value, float) and not isfinite(value)
    return str(value) if infinite else value


def _as_float(value: Any) -> Any:
    """Convert integers to floats, but not booleans."""
    if isinstance(value, bool):
        raise dacite.WrongTypeError(float, value)
    try:
        return float(value) if isinstance(value, int) else value
    except OverflowError as error:
        raise dacite.WrongTypeError(float, value) from error


def _as_int(value: Any) -> Any:
    """Reject booleans, which are integers in Python."""
    if isinstance(value, bool):
        raise dacite.WrongTypeError(int, value)
    return value


HOOKS: dict[type[Any], Callable[[Any], Any]]
HOOKS = {float: _as_float, int: _as_int}  # numbers in TOML and JSON files


def _as_room(value: Any) -> Any:
    """Convert the entries of a room file to a room."""
    return room_from_entries(value) if isinstance(value, dict) else value


def _unfolded(value: Any) -> Any:
    """Convert settings to nested entries, and rooms to those of a file."""
    if isinstance(value, Room):
        return room_to_entries(value)
    if isinstance(value, list | tuple):
        return [_unfolded(entry) for entry in value]
    if not is_dataclass(value):
        return value
    return {f.name: _unfolded(getattr(value, f.name)) for f in fields(value)}


def _plain(value: Any) -> Any:
    """Drop entries that are None, which TOML cannot represent."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items() if v is not None}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return value.value if isinstance(value, Enum) else value
