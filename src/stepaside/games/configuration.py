"""Configurations as files: TOML in, TOML out."""

import tomllib
from collections.abc import Callable
from dataclasses import asdict
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Any

import dacite
import tomli_w

from ..errors import ConfigurationError
from .settings import DuelSettings


def load_configuration(path: Path) -> DuelSettings:
    """Read the configuration of a duel.

    Args:
        path: TOML file; what it leaves out keeps its default.

    Raises:
        ConfigurationError: If it is not TOML, or an entry is unknown, of
            the wrong type or out of its range.
    """
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigurationError(f"{path}: {error}") from error
    return parse_configuration(entries, str(path))


def parse_configuration(entries: dict[str, Any], source: str) -> DuelSettings:
    """Turn nested entries into settings.

    Args:
        entries: Sections and values.
        source: Where they come from, for messages.

    Raises:
        ConfigurationError: As :func:`load_configuration`.
    """
    hooks: dict[type[Any], Callable[[Any], Any]]
    hooks = {float: _as_float, int: _as_int}
    config = dacite.Config(strict=True, type_hooks=hooks)
    try:
        return dacite.from_dict(DuelSettings, entries, config)
    except dacite.UnexpectedDataError as error:
        unknown = ", ".join(sorted(error.keys))
        raise ConfigurationError(
            f"{source}: unknown entry {unknown}"
        ) from error
    except dacite.WrongTypeError as error:
        raise ConfigurationError(
            f"{source}: {error.field_path} must be a "
            f"{getattr(error.field_type, '__name__', error.field_type)}, "
            f"got {error.value!r}"
        ) from error


def dump_configuration(settings: DuelSettings) -> str:
    """Text of the configuration that repeats a duel, as TOML."""
    return tomli_w.dumps(plain_settings(settings))


def plain_settings(settings: DuelSettings) -> dict[str, Any]:
    """Nested entries of settings, as a configuration has them."""
    entries: dict[str, Any] = _plain(asdict(settings))
    return entries


def spelled_settings(settings: DuelSettings) -> dict[str, Any]:
    """Settings for JSON, with what it has no number for spelled out."""
    entries: dict[str, Any] = _spelled(plain_settings(settings))
    return entries


def _spelled(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _spelled(entry) for key, entry in value.items()}
    endless = isinstance(value, float) and not isfinite(value)
    return str(value) if endless else value


def _as_float(value: Any) -> Any:
    """Take whole numbers for real ones."""
    if isinstance(value, bool):
        raise dacite.WrongTypeError(float, value)
    return float(value) if isinstance(value, int) else value


def _as_int(value: Any) -> Any:
    """Refuse true and false, which Python takes for numbers."""
    if isinstance(value, bool):
        raise dacite.WrongTypeError(int, value)
    return value


def _plain(value: Any) -> Any:
    """Leave out what is None, which TOML does not know."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items() if v is not None}
    return value.value if isinstance(value, Enum) else value
