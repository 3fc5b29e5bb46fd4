"""Configurations as files: TOML in, TOML out, for any settings."""

import tomllib
from collections.abc import Callable, Collection
from dataclasses import fields, is_dataclass
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import dacite
import tomli_w

from ..arena import Room, room_entries, room_of_entries
from ..core.errors import (
    AnyPath,
    ConfigurationError,
    StepAsideError,
    as_path,
    shown,
)
from .duel_settings import DuelSettings


def renamed(entries: dict[str, Any], old: str, new: str) -> dict[str, Any]:
    """Entries with an old name, if it is there, replaced by the new one.

    Raises:
        KeyError: If both are there.
    """
    section, deeper, old_rest = old.partition(".")
    new_rest = new.partition(".")[2]
    if deeper:
        inner = entries.get(section)
        if not isinstance(inner, dict):
            return entries
        return entries | {section: renamed(inner, old_rest, new_rest)}
    if old in entries and new in entries:
        raise KeyError(old)
    return {new if key == old else key: v for key, v in entries.items()}


def over(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Entries of both; those above win."""
    merged = below | above
    for key in below.keys() & above.keys():
        if isinstance(below[key], dict) and isinstance(above[key], dict):
            merged[key] = over(below[key], above[key])
    return merged


def without(entries: dict[str, Any], old: str) -> dict[str, Any]:
    """Entries without one."""
    section, deeper, rest = old.partition(".")
    inner = entries.get(section)
    if deeper and isinstance(inner, dict):
        return entries | {section: without(inner, rest)}
    return {key: v for key, v in entries.items() if key != old}


def with_tuples(kind: Any, entries: dict[str, Any]) -> dict[str, Any]:
    """Entries with tuples for the lists that settings keep as such."""
    changed = dict(entries)
    hints = get_type_hints(kind)
    for key in entries.keys() & hints.keys():
        value, hint = entries[key], hints[key]
        if isinstance(value, list) and get_origin(hint) is tuple:
            changed[key] = tuple(value)
        elif isinstance(value, dict) and is_dataclass(hint):
            changed[key] = with_tuples(hint, value)
    return changed


S = TypeVar("S")  # a frozen dataclass of settings

LONGEST = 2**20  # text of a configuration, in [characters]

# Entries of older files, and what they are called today.
RENAMED = {
    "body.play": "body.backlash",
}


# Entries of older files that mean nothing any more.
RETIRED = (
    "control.stabiliser.lead_blend",
    "control.stabiliser.prediction_blend",
)


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
        path: TOML file; what it leaves out keeps its default.
        aside: Entries that are left aside, for they belong to others.
        base: Settings whose values are the defaults; those of the class by
            default.

    Raises:
        ConfigurationError: If it is not TOML, or an entry is unknown, of
            the wrong type or out of its range.
    """
    entries = load_entries(path)
    return parse_settings(kind, entries, str(path), aside=aside, base=base)


def load_entries(path: Path) -> dict[str, Any]:
    """Nested entries of a TOML file.

    Raises:
        ConfigurationError: If it cannot be read, or is no TOML.
    """
    try:
        with path.open("rb") as file:
            text = file.read(LONGEST + 1).decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path}: {error}") from error
    return read_entries(text, str(path))


def says(path: Path, entry: str) -> bool:
    """Whether a configuration that was read has an entry.

    Args:
        path: TOML file.
        entry: Like ``control.method``.
    """
    found: Any = tomllib.loads(path.read_text(encoding="utf-8"))
    for name in entry.split("."):
        if not isinstance(found, dict) or name not in found:
            return False
        found = found[name]
    return True


def read_settings(
    kind: type[S], text: str, source: str, *, aside: Collection[str] = ()
) -> S:
    """Turn TOML into settings.

    Args:
        kind: Class of the settings.
        text: TOML.
        source: Where it comes from, for messages.
        aside: As :func:`load_settings`.

    Raises:
        ConfigurationError: As :func:`load_settings`.
    """
    return parse_settings(
        kind, read_entries(text, source), source, aside=aside
    )


def read_entries(text: str, source: str) -> dict[str, Any]:
    """Nested entries of TOML.

    Args:
        text: TOML.
        source: Where it comes from, for messages.

    Raises:
        ConfigurationError: If it is none, or too long.
    """
    if len(text) > LONGEST:
        raise ConfigurationError(
            f"{source} must have at most {LONGEST} characters"
        )
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        raise ConfigurationError(f"{source} is nested too deep") from error
    except ValueError as error:  # no TOML, or a number without end
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
        entries: Sections and values; old names are taken for new ones.
        source: Where they come from, for messages.
        aside: As :func:`load_settings`.
        base: Likewise.

    Raises:
        ConfigurationError: As :func:`load_settings`.
    """
    own = {field.name for field in fields(kind)}  # type: ignore[arg-type]
    left = set(aside) - own
    entries = {key: v for key, v in entries.items() if key not in left}
    for old, new in RENAMED.items():
        try:
            entries = renamed(entries, old, new)
        except KeyError:
            raise ConfigurationError(
                f"{source}: {old} is the old name of {new}, "
                "give one of them, not both"
            ) from None
    for old in RETIRED:
        entries = without(entries, old)
    if base is not None:
        entries = over(plain_settings(base), entries)
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
        raise ConfigurationError(  # a section where a list is due, or so
            f"{source}: entries are not of their kinds: {error}"
        ) from error


def load_configuration(path: AnyPath) -> DuelSettings:
    """Read the configuration of a duel; see :func:`load_settings`."""
    return load_settings(DuelSettings, as_path(path, "path"))


def parse_configuration(entries: dict[str, Any], source: str) -> DuelSettings:
    """Turn entries into those of a duel; see :func:`parse_settings`."""
    return parse_settings(DuelSettings, entries, source)


def dump_configuration(settings: Any) -> str:
    """Text of the configuration that gives settings again, as TOML."""
    return tomli_w.dumps(plain_settings(settings))


def plain_settings(settings: Any) -> dict[str, Any]:
    """Nested entries of settings, as a configuration has them."""
    if isinstance(settings, DuelSettings):
        settings = settings.named()
    entries: dict[str, Any] = _plain(_unfolded(settings))
    return entries


def spelled_settings(settings: Any) -> dict[str, Any]:
    """Settings for JSON, with what it has no number for spelled out."""
    entries: dict[str, Any] = _spelled(plain_settings(settings))
    return entries


def _type_name(kind: Any) -> str:
    if get_origin(kind) is Literal:
        return f"one of {', '.join(map(str, get_args(kind)))}"
    return f"a {getattr(kind, '__name__', kind)}"


def _spelled(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _spelled(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_spelled(entry) for entry in value]
    endless = isinstance(value, float) and not isfinite(value)
    return str(value) if endless else value


def _as_float(value: Any) -> Any:
    """Take whole numbers for real ones."""
    if isinstance(value, bool):
        raise dacite.WrongTypeError(float, value)
    try:
        return float(value) if isinstance(value, int) else value
    except OverflowError as error:
        raise dacite.WrongTypeError(float, value) from error


def _as_int(value: Any) -> Any:
    """Refuse true and false, which Python takes for numbers."""
    if isinstance(value, bool):
        raise dacite.WrongTypeError(int, value)
    return value


HOOKS: dict[type[Any], Callable[[Any], Any]]
HOOKS = {float: _as_float, int: _as_int}  # what files have for numbers


def _as_room(value: Any) -> Any:
    """Take the entries of a room file for a room."""
    return room_of_entries(value) if isinstance(value, dict) else value


def _unfolded(value: Any) -> Any:
    """Settings as nested entries, and rooms as their files have them."""
    if isinstance(value, Room):
        return room_entries(value)
    if isinstance(value, list | tuple):
        return [_unfolded(entry) for entry in value]
    if not is_dataclass(value):
        return value
    return {f.name: _unfolded(getattr(value, f.name)) for f in fields(value)}


def _plain(value: Any) -> Any:
    """Leave out what is None, which TOML does not know."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items() if v is not None}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return value.value if isinstance(value, Enum) else value
