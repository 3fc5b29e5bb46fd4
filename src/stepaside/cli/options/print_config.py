"""Configuration text in which a comment explains each entry."""

from dataclasses import fields, is_dataclass
from enum import Enum
from textwrap import wrap
from typing import Any

from ...arena import Room, room_to_entries
from ...core.setting import settings_of

WIDTH = 76  # characters of a comment


def commented(settings: Any) -> str:
    """Return a configuration in TOML with a comment above each entry.

    Args:
        settings: Settings; the comments are their descriptions.
    """
    return "\n".join([_summary(settings), *_lines(settings, ())]) + "\n"


def _summary(settings: Any) -> str:
    return f"# {(type(settings).__doc__ or '').splitlines()[0]}"


def _lines(settings: Any, section: tuple[str, ...]) -> list[str]:
    """Return the entries of a section, then its subsections."""
    described = settings_of(type(settings))
    lines, subsections = [], []
    for field in fields(settings):
        value = getattr(settings, field.name)
        comment = _comment(described[field.name].full_text)
        path = (*section, field.name)
        if isinstance(value, Room):
            subsections += ["", comment, _room(value, path)]
        elif is_dataclass(value):
            subsections += ["", comment, f"[{'.'.join(path)}]"]
            subsections += _lines(value, path)
        elif value is None:
            lines += [comment, f"# {field.name} ="]
        else:
            lines += [comment, f"{field.name} = {_inline(value)}"]
    return lines + subsections


def _room(room: Room, section: tuple[str, ...]) -> str:
    """Return a room in the format of room files, inside a section."""
    import tomli_w

    entries: dict[str, Any] = room_to_entries(room)
    for name in reversed(section):
        entries = {name: entries}
    # The outermost section is open already.
    text = tomli_w.dumps(entries)
    return text.replace(f"[{section[0]}]\n", "", 1).strip()


def _comment(text: str) -> str:
    return "\n".join(f"# {line}" for line in wrap(text, WIDTH)) or "#"


def _inline(value: Any) -> str:
    """Return a value as one line of TOML."""
    import tomli_w

    if is_dataclass(value):
        pairs = ((f.name, getattr(value, f.name)) for f in fields(value))
        inner = ", ".join(
            f"{name} = {_inline(entry)}"
            for name, entry in pairs
            if entry is not None
        )
        return f"{{ {inner} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_inline, value))}]"
    if isinstance(value, Enum):
        value = value.value
    return tomli_w.dumps({"x": value}).removeprefix("x = ").strip()
