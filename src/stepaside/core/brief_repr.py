"""Short text of values, for interactive sessions and notebooks."""

from collections.abc import Collection, Mapping
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

MOST = 4  # longest list or mapping written out, in [entries]
LONGEST = 80  # longest text of one entry, in [characters]


def brief_repr(value: Any) -> str:
    """Write a dataclass or a named tuple as one short line.

    Fields at their default are omitted, arrays are shown by shape, and long
    collections by length.
    """
    if is_dataclass(value):
        defaults = {f.name: _default(f) for f in fields(value) if f.repr}
    else:
        defaults = dict.fromkeys(value._fields, MISSING)
        defaults.update(value._field_defaults)
    shown = []
    for name, default in defaults.items():
        own = getattr(value, name)
        arrays = hasattr(own, "shape") or type(own) is not type(default)
        if own is not default and (arrays or own != default):
            shown.append(f"{name}={_brief(own)}")
    return f"{type(value).__name__}({', '.join(shown)})"


def _default(field: Any) -> Any:
    made = field.default_factory
    return field.default if made is MISSING else made()


def _brief(value: Any) -> str:
    if getattr(value, "shape", ()):
        return f"array{tuple(value.shape)}"
    if isinstance(value, float):
        return min(repr(value), f"{value:.6g}", key=len)
    if is_dataclass(value) and not isinstance(value, type):
        return brief_repr(value)
    if isinstance(value, Collection) and not isinstance(value, str | bytes):
        if len(value) > MOST:
            return f"<{len(value)} entries>"
        if isinstance(value, Mapping):
            pairs = (f"{key!r}: {_brief(one)}" for key, one in value.items())
            return "{" + ", ".join(pairs) + "}"
        if type(value) in (list, tuple):
            return f"[{', '.join(map(_brief, value))}]"
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
