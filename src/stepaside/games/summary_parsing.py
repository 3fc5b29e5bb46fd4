"""Figures of games, from plain values."""

from collections.abc import Mapping
from typing import Any, TypeVar

import dacite

from ..core.errors import ConfigurationError
from .configuration_file import HOOKS

F = TypeVar("F")


def check_object(plain: Any, source: str) -> dict[str, Any]:
    """Give an object of JSON back, or refuse what is none.

    Args:
        plain: What JSON held.
        source: Where it comes from, for messages.

    Raises:
        ConfigurationError: If it is something else.
    """
    if not isinstance(plain, dict):
        raise ConfigurationError(
            f"{source} must hold one JSON object, got {type(plain).__name__}"
        )
    return plain


def read_figures(kind: type[F], plain: Any, source: str) -> F:
    """Turn plain values into figures.

    Args:
        kind: Class of the figures.
        plain: Values by name.
        source: Where they come from, for messages.

    Raises:
        ConfigurationError: If it is no such thing; names what is off.
    """
    entries: Mapping[str, Any] = check_object(plain, source)
    config = dacite.Config(type_hooks=HOOKS, cast=[tuple])
    try:
        return dacite.from_dict(kind, entries, config)
    except (dacite.DaciteError, TypeError, AttributeError) as error:
        raise ConfigurationError(f"{source}: {error}") from error
