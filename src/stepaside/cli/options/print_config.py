"""Settings as a configuration that explains itself."""

import re
from dataclasses import fields, is_dataclass
from enum import Enum
from textwrap import wrap
from typing import Any

from ...arena import Room, room_entries

WIDTH = 76  # characters of a comment


def commented(settings: Any) -> str:
    """Text of a configuration, in TOML, with the meaning of each entry.

    Args:
        settings: Any settings; what their docstrings say of each attribute
            becomes the comment.
    """
    return "\n".join([_summary(settings), *_lines(settings, ())]) + "\n"


def meanings(kind: type[Any]) -> dict[str, str]:
    """What the docstring of a class says of each attribute."""
    _, _, listed = (kind.__doc__ or "").partition("Attributes:")
    found: dict[str, str] = {}
    indent, name = "", ""
    for line in listed.splitlines():
        entry = re.match(r"( +)(\w+): (.*)", line)
        if entry and (not indent or entry[1] == indent):
            indent, name = entry[1], entry[2]
            found[name] = entry[3]
        elif name and line.strip():
            found[name] += " " + line.strip()
        elif name:
            break
    return {key: _plain(text) for key, text in found.items()}


def _plain(text: str) -> str:
    """Text without symbols and the marks of reStructuredText."""
    text = re.sub(r" :math:`[^`]*`", "", text)
    return re.sub(r":\w+:`~?([^`]*)`|``([^`]*)``", r"\1\2", text)


def _summary(settings: Any) -> str:
    return f"# {(type(settings).__doc__ or '').splitlines()[0]}"


def _lines(settings: Any, section: tuple[str, ...]) -> list[str]:
    """Entries of a section, then the sections in it."""
    told = meanings(type(settings))
    lines, deeper = [], []
    for field in fields(settings):
        value = getattr(settings, field.name)
        if isinstance(value, Room):
            here = (*section, field.name)
            deeper += ["", _comment(told.get(field.name, ""))]
            deeper.append(_room(value, here))
            continue
        if is_dataclass(value):
            here = (*section, field.name)
            deeper += ["", _comment(told.get(field.name, ""))]
            deeper += [f"[{'.'.join(here)}]", *_lines(value, here)]
            continue
        lines.append(_comment(told.get(field.name, "")))
        lines.append(
            f"# {field.name} ="
            if value is None
            else f"{field.name} = {_inline(value)}"
        )
    return lines + deeper


def _room(room: Room, section: tuple[str, ...]) -> str:
    """A room in the way of its files, in a section."""
    import tomli_w

    entries: dict[str, Any] = room_entries(room)
    for name in reversed(section):
        entries = {name: entries}
    # The section above has been opened already.
    text = tomli_w.dumps(entries)
    return text.replace(f"[{section[0]}]\n", "", 1).strip()


def _comment(text: str) -> str:
    return "\n".join(f"# {line}" for line in wrap(text, WIDTH)) or "#"


def _inline(value: Any) -> str:
    """A value on one line of TOML."""
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
