"""Parsing of summaries from plain JSON values."""

from collections.abc import Mapping
from typing import Any, TypeVar

import dacite

from ..core.errors import ConfigurationError
from .configuration_file import HOOKS

F = TypeVar("F")


def check_object(plain: Any, source: str) -> dict[str, Any]:
    """Return a JSON object unchanged; reject any other value.

    Args:
        plain: JSON value.
        source: Origin of the value, for messages.

    Raises:
        ConfigurationError: If the value is not an object.
    """
    if not isinstance(plain, dict):
        raise ConfigurationError(
            f"{source} must hold one JSON object, got {type(plain).__name__}"
        )
    return plain


def parse_summary(kind: type[F], plain: Any, source: str) -> F:
    """Parse plain values into a summary.

    Args:
        kind: Class of the summary.
        plain: Values by name.
        source: Origin of the values, for messages.

    Raises:
        ConfigurationError: If an entry is missing or of the wrong type;
            names the entry.
    """
    entries: Mapping[str, Any] = check_object(plain, source)
    config = dacite.Config(type_hooks=HOOKS, cast=[tuple])
    try:
        return dacite.from_dict(kind, entries, config)
    except (dacite.DaciteError, TypeError, AttributeError) as error:
        raise ConfigurationError(f"{source}: {error}") from error
