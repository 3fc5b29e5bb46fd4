"""Text of ``robot.toml``: values with comments, and their changes."""

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from textwrap import fill
from typing import Any

from ..robots.description import RobotDescription
from ..robots.description_types import NO_OVERLAY
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
    entries = asdict(own)
    overlay = entries["overlay"]
    overlay |= {"soles": [*overlay["soles"]], "servos": _servos(own)}
    if own.overlay.turn == NO_OVERLAY.turn:
        del overlay["turn"]
    if not own.lean:
        del entries["lean"]
    entries["legs"] = [leg.joints for leg in derived.analysis.legs]
    del entries["folder"], entries["sensors"]
    return {k: v for k, v in entries.items() if v != {}}


def _words(derived: DerivedDescription) -> dict[str, str]:
    """Return what the texts of the comments hold in braces."""
    own, analysis, high = (
        derived.description,
        derived.analysis,
        derived.highest,
    )
    left, right = analysis.legs
    missing, torques = analysis.missing, ", ".join(derived.assumed_torques)
    some = len(derived.assumed_speeds) < len(own.speed_limits)
    joints = f" of {', '.join(derived.assumed_speeds)}" * some
    load = 100.0 * derived.loads.usual
    return {
        "robot": own.name,
        "meshes": f"Geoms are removed of {len(missing)} mesh files, like "
        f"{missing[0]}: missing ones (--meshes names folders), others than "
        "binary .stl, .obj or .msh (convert them)."
        if missing
        else "",
        "coupled": ", ".join(sorted(followers_of(analysis.model))) or "none",
        "speeds": f"{ASK} no-load speeds{joints}, in [rad/s]."
        if derived.assumed_speeds
        else "Speed limits of the model, in [rad/s].",
        "sole": f"{ASK} a guess from the length of the leg, measure it"
        if left.is_guessed
        else f"lowest points of the geoms of {left.foot} and {right.foot}",
        "lengths": f", times {derived.lengths:.2f} for the speed limits"
        if derived.lengths < 1.0
        else "",
        "height": f"{derived.size.com_height / high:.2f} of the greatest in "
        f"reach ({derived.lowest:.3f} to {high:.3f})",
        "zmp": f", times {derived.zmp_offset:g} for the ankle torques"
        if derived.zmp_offset < 1.0
        else "",
        "weak": f", but no more than the torque limit over {SATURATION_ANGLE} "
        f"rad, since a step takes {load:.0f} % of a torque limit most of the "
        "time"
        if derived.is_weak
        else "",
        "torques": f"{ASK} torque limits of {torques}." if torques else "",
    }


def _servos(own: RobotDescription) -> dict[str, dict[str, float]]:
    """Return the gains of all servos, without armatures of 0."""
    return {
        joint: {k: v for k, v in asdict(gains).items() if k != "armature" or v}
        for joint, gains in own.overlay.servos.items()
    }


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
        if prefix or not all(isinstance(v, Mapping) for v in value.values()):
            yield f"[{name}]"
        yield from _lines(value, f"{name}.", above, beside)


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        pairs = (f"{_key(k)} = {_value(v)}" for k, v in value.items())
        return f"{{ {', '.join(pairs)} }}"
    if isinstance(value, list) and value:  # of rows
        rows = (_value(each) for each in value)
        if isinstance(value[0], tuple):
            rows = (row[1:-1] for row in rows)  # one list, row by row
        return "[\n" + "".join(f"    {row},\n" for row in rows) + "]"
    return json.dumps(value, ensure_ascii=False)


def _key(name: str) -> str:
    plain = name.replace("_", "").replace("-", "")
    return name if plain.isascii() and plain.isalnum() else _value(name)


def _comment(text: str) -> Iterator[str]:
    """Wrap each line of a text into comments of at most 79 characters."""
    for part in filter(str.strip, text.splitlines()):
        yield fill(
            part,
            79,
            initial_indent="# ",
            subsequent_indent="# ",
            break_long_words=False,
            break_on_hyphens=False,
        )


def rewrite_description(
    text: str, tuned: RobotDescription, words: list[str]
) -> str:
    """Return the text of a description with the values of a search.

    Comments stay; a changed value has one on its previous value. New keys
    are at the ends of their sections.
    """
    tables: dict[str, dict[str, Any]] = {
        "": {"lean": tuned.lean} if tuned.lean > 0.0 else {},
        "gait": dict(tuned.gait),
        "control": {k: tuned.control[k] for k in ("method", "feedback")},
        "overlay.servos": dict(_servos(tuned)),
    }
    present = text.splitlines()
    if present and present[0] == TITLE:
        present = present[present.index("#", 1) + 1 :]
    lines: list[str] = []
    ends: dict[str, int] = {}  # of the entries of each section
    section = ""
    for line in present:
        if head := SECTION.match(line):
            section = head[1].strip()
        entry, values = ENTRY.match(line), tables.get(section, {})
        if entry and entry[2].strip('"') in values:
            line = _changed(entry, _value(values.pop(entry[2].strip('"'))))
        lines.append(line)
        if line.strip() and not line.startswith("#"):
            ends[section] = len(lines)
    for section in sorted(tables, key=lambda s: -ends.get(s, len(lines))):
        added = [
            f"{_key(k)} = {_value(v)}" for k, v in tables[section].items()
        ]
        if added and section not in ends:
            added = ["", f"[{section}]", *added]
        at = ends.get(section, len(lines))
        lines[at:at] = added
    top = [TITLE, *(f"# {word}" for word in words), "#"]
    return "\n".join([*top, *lines]) + "\n"


def _changed(entry: re.Match[str], value: str) -> str:
    """Return the line of an entry with a new value."""
    if value == entry[3]:
        return entry[0]
    comments = [] if value[0] == "{" else [f"tuned, was {entry[3]}"]
    old = re.sub(r"tuned, was [^;]*;? ?", "", (entry[4] or "")[1:]).strip()
    comments += [old] if old else []
    comment = f" # {'; '.join(comments)}" if comments else ""
    return f"{f'{entry[2]} = {value}':<32}{comment}".rstrip()
