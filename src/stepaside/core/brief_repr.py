"""Short text of values, for interactive sessions and notebooks."""

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

MOST = 4  # longest list or mapping written out, in [entries]
DIGITS = 6  # significant ones of a number
LONGEST = 80  # longest text of one entry, in [characters]


def brief_repr(value: Any) -> str:
    """Write a dataclass or a named tuple as one short line.

    Fields at their default are omitted, arrays are shown by shape, and long
    collections by length.

    Args:
        value: Instance of a dataclass or of a named tuple.
    """
    shown = [
        f"{name}={_brief(getattr(value, name))}"
        for name, default in _defaults(value)
        if not _equals(getattr(value, name), default)
    ]
    return f"{type(value).__name__}({', '.join(shown)})"


def _defaults(value: Any) -> Iterator[tuple[str, Any]]:
    """Yield fields with their defaults; ``MISSING`` if there is none."""
    if not is_dataclass(value):
        for name in value._fields:
            yield name, value._field_defaults.get(name, MISSING)
        return
    for field in fields(value):
        default = field.default
        if field.default_factory is not MISSING:
            default = field.default_factory()
        if field.repr:
            yield field.name, default


def _equals(value: Any, default: Any) -> bool:
    """Return whether a value is its default; arrays never are."""
    if value is default:
        return True
    same = type(value) is type(default) and not hasattr(value, "shape")
    return same and bool(value == default)


def _brief(value: Any) -> str:
    if getattr(value, "shape", ()):
        return f"array{tuple(value.shape)}"
    if isinstance(value, float):
        return (
            f"{value:.{DIGITS}g}" if len(repr(value)) > DIGITS else repr(value)
        )
    if is_dataclass(value) and not isinstance(value, type):
        return brief_repr(value)
    if isinstance(value, Mapping | list | tuple | set | frozenset):
        if len(value) > MOST:
            return f"<{len(value)} entries>"
        if isinstance(value, Mapping):
            pairs = (f"{key!r}: {_brief(one)}" for key, one in value.items())
            return "{" + ", ".join(pairs) + "}"
        if type(value) in (list, tuple):
            return f"[{', '.join(map(_brief, value))}]"
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
