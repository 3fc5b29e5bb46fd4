"""Values of a description changed in place, its comments kept."""

import re
from collections.abc import Mapping
from typing import Any

from ..robots.description import RobotDescription

SECTION = re.compile(r"\s*\[([^\]]+)\]\s*(#.*)?$")
ENTRY = re.compile(
    r"(\s*)(\"[^\"]+\"|[A-Za-z0-9_-]+)\s*=\s*([^#]*?)\s*(#.*)?$"
)
TITLE = "# Tuned by `stepaside robot tune`:"


def rewritten(text: str, tuned: RobotDescription, words: list[str]) -> str:
    """Text of a description with what a search found.

    Args:
        text: The robot.toml as it is.
        tuned: Description with other gait, control and servos.
        words: What was measured, for a comment at the top; it replaces that
            of an earlier search.
    """
    control = {k: tuned.control[k] for k in ("method", "feedback")}
    if tuned.lean > 0.0:
        text = _with(text, "", {"lean": tuned.lean})
    text = _with(text, "gait", dict(tuned.gait))
    text = _with(text, "control", control)
    if tuned.overlay.servos:
        text = _with_servos(text, tuned)
    lines = text.splitlines()
    if lines and lines[0] == TITLE:
        lines = lines[lines.index("#", 1) + 1 :]
    head = [TITLE, *(f"# {word}" for word in words), "#"]
    return "\n".join([*head, *lines]) + "\n"


def _with(text: str, section: str, values: Mapping[str, Any]) -> str:
    """Text with other values in one section; new ones at its end."""
    left, lines, last = dict(values), [], None
    now = ""
    for line in text.splitlines():
        head = SECTION.match(line)
        if head:
            now = head[1].strip()
        lines.append(line)
        if now != section:
            continue
        if line.strip() and not line.startswith("#"):
            last = len(lines)
        entry = ENTRY.match(line)
        name = entry[2].strip('"') if entry else ""
        if entry and name in left:
            value = _spelled(left.pop(name))
            if value != entry[3]:
                was = f"# tuned, was {entry[3]}"
                why = f"; {entry[4][1:].strip()}" if entry[4] else ""
                why = re.sub(r"; tuned, was [^;]*", "", why)
                lines[-1] = f"{f'{entry[2]} = {value}':<32} {was}{why}"
    added = [f"{name} = {_spelled(value)}" for name, value in left.items()]
    if last is None:
        return "\n".join([*lines, "", f"[{section}]", *added]) + "\n"
    lines[last:last] = added
    return "\n".join(lines) + "\n"


def _with_servos(text: str, tuned: RobotDescription) -> str:
    """Text with other stiffness and damping of the servos."""
    lines, now = [], ""
    for line in text.splitlines():
        head = SECTION.match(line)
        now = head[1].strip() if head else now
        entry = ENTRY.match(line)
        if now == "overlay.servos" and entry:
            gains = tuned.overlay.servos[entry[2].strip('"')]
            for key in ("stiffness", "damping"):
                value = _spelled(getattr(gains, key))
                line = re.sub(rf"\b{key} = [^,}}]*", f"{key} = {value}", line)
        lines.append(line)
    return "\n".join(lines) + "\n"


def _spelled(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else repr(float(value))
