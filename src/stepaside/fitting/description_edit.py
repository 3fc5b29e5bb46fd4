"""In-place edit of a robot description that preserves its comments."""

import re
from collections.abc import Mapping
from typing import Any

from ..robots.description import RobotDescription

SECTION = re.compile(r"\s*\[([^\]]+)\]\s*(#.*)?$")
ENTRY = re.compile(
    r"(\s*)(\"[^\"]+\"|[A-Za-z0-9_-]+)\s*=\s*([^#]*?)\s*(#.*)?$"
)
TITLE = "# Tuned by `stepaside robot tune`:"


def rewrite_description(
    text: str, tuned: RobotDescription, words: list[str]
) -> str:
    """Return the text of a description with the values of a search.

    Args:
        text: Present content of ``robot.toml``.
        tuned: Description with new gait, control and servos.
        words: Lines of a comment at the top, which replaces that of an
            earlier search.
    """
    control = {k: tuned.control[k] for k in ("method", "feedback")}
    if tuned.lean > 0.0:
        text = _with_values(text, "", {"lean": tuned.lean})
    text = _with_values(text, "gait", dict(tuned.gait))
    text = _with_values(text, "control", control)
    if tuned.overlay.servos:
        text = _with_servos(text, tuned)
    lines = text.splitlines()
    if lines and lines[0] == TITLE:
        lines = lines[lines.index("#", 1) + 1 :]
    head = [TITLE, *(f"# {word}" for word in words), "#"]
    return "\n".join([*head, *lines]) + "\n"


def _with_values(text: str, section: str, values: Mapping[str, Any]) -> str:
    """Return the text with new values in a section, new keys at its end."""
    remaining = dict(values)
    lines: list[str] = []
    end: int | None = None  # of the entries of the section
    current = ""
    for line in text.splitlines():
        head = SECTION.match(line)
        if head:
            current = head[1].strip()
        lines.append(line)
        if current != section:
            continue
        if line.strip() and not line.startswith("#"):
            end = len(lines)
        entry = ENTRY.match(line)
        name = entry[2].strip('"') if entry else ""
        if entry and name in remaining:
            value = _toml(remaining.pop(name))
            if value != entry[3]:
                was = f"# tuned, was {entry[3]}"
                comment = f"; {entry[4][1:].strip()}" if entry[4] else ""
                comment = re.sub(r"; tuned, was [^;]*", "", comment)
                lines[-1] = f"{f'{entry[2]} = {value}':<32} {was}{comment}"
    added = [f"{name} = {_toml(value)}" for name, value in remaining.items()]
    if end is None:
        return "\n".join([*lines, "", f"[{section}]", *added]) + "\n"
    lines[end:end] = added
    return "\n".join(lines) + "\n"


def _with_servos(text: str, tuned: RobotDescription) -> str:
    """Return the text with new stiffness and damping of the servos."""
    lines: list[str] = []
    current = ""
    for line in text.splitlines():
        head = SECTION.match(line)
        current = head[1].strip() if head else current
        entry = ENTRY.match(line)
        if current == "overlay.servos" and entry:
            gains = tuned.overlay.servos[entry[2].strip('"')]
            for key in ("stiffness", "damping"):
                value = _toml(getattr(gains, key))
                line = re.sub(rf"\b{key} = [^,}}]*", f"{key} = {value}", line)
        lines.append(line)
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else repr(float(value))
