"""Short text of values, for interactive sessions and notebooks."""

from dataclasses import MISSING, fields, is_dataclass
from typing import Any

MOST = 4  # longest list or mapping written out, in [entries]
LONGEST = 80  # longest text of one entry, in [characters]


def brief_repr(value: Any) -> str:
    """Write a dataclass as one short line.

    Fields at their default are omitted, arrays are shown by shape, and long
    collections by length.
    """
    shown = []
    for each in fields(value):
        own, made = getattr(value, each.name), each.default_factory
        default = each.default if made is MISSING else made()
        if each.repr and (type(own) is not type(default) or own != default):
            shown.append(f"{each.name}={_brief(own)}")
    return f"{type(value).__name__}({', '.join(shown)})"


def _brief(value: Any) -> str:
    if getattr(value, "shape", ()):
        return f"array{tuple(value.shape)}"
    if isinstance(value, float):
        return f"{value:.6g}"
    if is_dataclass(value) and not isinstance(value, type):
        return brief_repr(value)
    if isinstance(value, tuple | list | dict) and len(value) > MOST:
        return f"<{len(value)} entries>"
    if type(value) in (list, tuple):
        return f"[{', '.join(map(_brief, value))}]"
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
