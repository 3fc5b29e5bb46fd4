"""Text of ``robot.toml``: values with comments, and their changes."""

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from textwrap import wrap
from typing import Any

from ..robots.description import RobotDescription
from ..robots.description_types import NO_OVERLAY, ServoGains
from .derivation import DerivedDescription
from .motor_data import SATURATION_ANGLE, followers_of

COMMENTS = Path(__file__).with_name("description_comments.toml")
ASK = "ASK: not in the model;"
TITLE = "# Tuned by `stepaside robot tune`:"
SECTION = re.compile(r"\s*\[([^\]]+)\]\s*(#.*)?$")
ENTRY = re.compile(
    r"(\s*)(\"[^\"]+\"|[A-Za-z0-9_-]+)\s*=\s*([^#]*?)\s*(#.*)?$"
)


def write_description(derived: DerivedDescription) -> str:
    """Return the text of a ``robot.toml``."""
    comments = tomllib.loads(COMMENTS.read_text(encoding="utf-8"))
    words = _words(derived)
    above, beside = (
        {name: text.format(**words) for name, text in comments[where].items()}
        for where in ("above", "beside")
    )
    return "\n".join(_lines(_entries(derived), "", above, beside)) + "\n"


def _entries(derived: DerivedDescription) -> dict[str, Any]:
    """Return the entries of the description, in the order of the file."""
    own = derived.description
    overlay: dict[str, Any] = {"meshes": own.overlay.meshes}
    if own.overlay.turn != NO_OVERLAY.turn:
        overlay["turn"] = own.overlay.turn
    overlay["soles"] = [asdict(sole) for sole in own.overlay.soles]
    overlay["servos"] = {
        name: _servo(gains) for name, gains in own.overlay.servos.items()
    }
    entries = {
        "name": own.name,
        "model": own.model,
        "torso": own.torso,
        "left_foot": own.left_foot,
        "right_foot": own.right_foot,
        "accent": "",
        "lean": own.lean or None,
        "legs": [leg.joints for leg in derived.analysis.legs],
        "standing": own.standing,
        "working_limits": own.working_limits,
        "speed_limits": own.speed_limits,
        "gait": own.gait,
        "sole": own.sole,
        "control": own.control,
        "game": asdict(own.game),
        "place": asdict(own.place),
        "body": own.body,
        "overlay": overlay,
        "published": own.published,
    }
    return {
        name: value
        for name, value in entries.items()
        if value is not None and value != {}
    }


def _words(derived: DerivedDescription) -> dict[str, str]:
    own, analysis, missing = derived.description, derived.analysis, ""
    if analysis.missing:
        missing = (
            f"{len(analysis.missing)} mesh files are missing or in a format "
            f"that MuJoCo does not read, like {analysis.missing[0]}: their "
            "geoms are removed."
        )
    left, right = analysis.legs
    sole = f"lowest points of the geoms of {left.foot} and {right.foot}"
    if left.is_guessed:
        sole = f"{ASK} a guess from the length of the leg, measure it"
    speeds = "Speed limits of the model, in [rad/s]."
    if assumed := derived.assumed_speeds:
        some = len(assumed) < len(own.speed_limits)
        joints = f" of {', '.join(assumed)}" * some
        speeds = f"{ASK} no-load speeds{joints}, in [rad/s]."
    torques = ", ".join(derived.assumed_torques)
    weak = (
        f", but no more than the torque limit over {SATURATION_ANGLE} rad, "
        f"since a step takes {100.0 * derived.loads.usual:.0f} % of a torque "
        "limit most of the time"
    )
    high = derived.highest
    times = f", times {derived.lengths:.2f} for the speed limits"
    zmp = f", times {derived.zmp_offset:g} for the ankle torques"
    return {
        "robot": own.name,
        "meshes": missing,
        "coupled": ", ".join(sorted(followers_of(analysis.model))) or "none",
        "speeds": speeds,
        "sole": sole,
        "lengths": times if derived.lengths < 1.0 else "",
        "height": f"{derived.size.com_height / high:.2f} of the greatest in "
        f"reach ({derived.lowest:.3f} to {high:.3f})",
        "zmp": zmp if derived.zmp_offset < 1.0 else "",
        "weak": weak if derived.is_weak else "",
        "torques": f"{ASK} torque limits of {torques}." if torques else "",
    }


def _servo(gains: ServoGains) -> dict[str, float]:
    return {k: v for k, v in asdict(gains).items() if k != "armature" or v}


def _lines(
    entries: Mapping[str, Any],
    prefix: str,
    above: Mapping[str, str],
    beside: Mapping[str, str],
) -> Iterator[str]:
    """Yield the lines of a table; dictionaries in it are tables, too."""
    tables = {k: v for k, v in entries.items() if isinstance(v, Mapping)}
    if prefix.count(".") == 2:  # such as a servo
        tables = {}
    for key, value in entries.items():
        if key not in tables:
            name = f"{prefix}{key}"
            yield from _comment(above.get(name, ""))
            text = f"{_key(key)} = {_value(value)}"
            comment = beside.get(name)
            yield f"{text:<32} # {comment}" if comment else text
    for key, value in tables.items():
        name = f"{prefix}{key}"
        yield ""
        yield from _comment(above.get(name, ""))
        if any(not isinstance(each, Mapping) for each in value.values()) or (
            prefix
        ):
            yield f"[{name}]"
        yield from _lines(value, f"{name}.", above, beside)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    if isinstance(value, Mapping):
        pairs = (f"{_key(k)} = {_value(v)}" for k, v in value.items())
        return f"{{ {', '.join(pairs)} }}"
    if isinstance(value, tuple | list):
        items = [_value(each) for each in value]
        if value and isinstance(value[0], tuple):
            items = [item[1:-1] for item in items]  # one list, row by row
        if value and not isinstance(value[0], str | float | int):
            rows = "".join(f"    {item},\n" for item in items)
            return f"[\n{rows}]"
        return f"[{', '.join(items)}]"
    return repr(float(value))


def _key(name: str) -> str:
    plain = name.replace("_", "").replace("-", "")
    return name if plain.isascii() and plain.isalnum() else _value(name)


def _comment(text: str) -> list[str]:
    """Wrap each line of a text into comments of at most 79 characters."""
    return [
        line
        for part in text.splitlines()
        for line in wrap(
            part,
            79,
            initial_indent="# ",
            subsequent_indent="# ",
            break_long_words=False,
            break_on_hyphens=False,
        )
    ]


def rewrite_description(
    text: str, tuned: RobotDescription, words: list[str]
) -> str:
    """Return the text of a description with the values of a search.

    Comments stay; a changed value has one on its previous value.
    """
    control = {k: tuned.control[k] for k in ("method", "feedback")}
    servos = {k: _servo(gains) for k, gains in tuned.overlay.servos.items()}
    lines = text.splitlines()
    if lines and lines[0] == TITLE:
        lines = lines[lines.index("#", 1) + 1 :]
    if tuned.lean > 0.0:
        lines = _replaced(lines, "", {"lean": tuned.lean})
    lines = _replaced(lines, "gait", tuned.gait)
    lines = _replaced(lines, "control", control)
    if servos:
        lines = _replaced(lines, "overlay.servos", servos)
    head = [TITLE, *(f"# {word}" for word in words), "#"]
    return "\n".join([*head, *lines]) + "\n"


def _replaced(
    present: list[str], section: str, values: Mapping[str, Any]
) -> list[str]:
    """Return lines with new values in a section, new keys at its end."""
    remaining = dict(values)
    lines: list[str] = []
    end: int | None = None  # of the entries of the section
    current = ""
    for line in present:
        if head := SECTION.match(line):
            current = head[1].strip()
        lines.append(line)
        if current != section:
            continue
        if line.strip() and not line.startswith("#"):
            end = len(lines)
        entry = ENTRY.match(line)
        name = entry[2].strip('"') if entry else ""
        if entry and name in remaining:
            value = _value(remaining.pop(name))
            if value == entry[3]:
                continue
            comments = [] if value[0] == "{" else [f"tuned, was {entry[3]}"]
            old = re.sub(r"tuned, was [^;]*;? ?", "", (entry[4] or "")[1:])
            comments += [old.strip()] if old.strip() else []
            comment = f" # {'; '.join(comments)}" if comments else ""
            lines[-1] = f"{f'{entry[2]} = {value}':<32}{comment}".rstrip()
    added = [f"{_key(k)} = {_value(v)}" for k, v in remaining.items()]
    if end is None:
        return [*lines, "", f"[{section}]", *added]
    return [*lines[:end], *added, *lines[end:]]
