"""Room files: read from TOML or JSON, written as TOML."""

import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import asdict
from inspect import signature
from typing import Any

import tomli_w

from ..core.errors import AnyPath, ConfigurationError, as_path
from ..core.poses import Pose
from .moving_box import MovingBox
from .obstacles import Obstacle
from .room import Door, Room
from .shapes import Box, Disc, Polygon, wall_between

ERROR = ConfigurationError
MAX_CHARACTERS = 2**20  # of a room file
LISTED = {"disc": "discs", "box": "boxes", "polygon": "polygons"}
SOLIDS = (*LISTED.values(), "walls")
LISTS = (*SOLIDS, "doors", "moving")
KNOWN = ("width", "depth", *LISTS, "pursuer", "evader")


def load_room(file: AnyPath) -> Room:
    """Read a room.

    Args:
        file: TOML file, or a JSON file with the suffix ".json".

    Raises:
        ConfigurationError: If the file cannot be read, or is invalid.
    """
    file = as_path(file, "file")
    try:
        with file.open("rb") as stream:
            text = stream.read(MAX_CHARACTERS + 1).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ERROR(f"room {file}: {reason.lower()}") from error
    if len(text) > MAX_CHARACTERS:
        raise ERROR(
            f"room {file} must have at most {MAX_CHARACTERS} characters"
        )
    read = json.loads if file.suffix.lower() == ".json" else tomllib.loads
    try:
        entries = read(text)
    except RecursionError as error:
        raise ERROR(f"room {file} is nested too deeply") from error
    except ValueError as error:
        raise ERROR(f"room {file}: {error}") from error
    if not isinstance(entries, dict):
        raise ERROR(f"room {file} must hold one object, got {entries!r:.40}")
    try:
        return room_from_entries(entries)
    except ConfigurationError as error:
        raise ERROR(f"room {file}: {error}") from error


def room_from_entries(entries: Mapping[str, Any]) -> Room:
    """Build a room from the entries of a file.

    Args:
        entries: ``width`` and ``depth``; lists ``discs`` (x, y, radius),
            ``boxes`` (x, y, width, depth, heading), ``polygons``
            (corners), ``walls`` (start, end, thickness), ``doors``
            (side, at, width) and ``moving`` boxes (x, y, width, depth, to,
            speed, heading); ``pursuer`` and ``evader`` (x, y, theta).

    Raises:
        ConfigurationError: If an entry is unknown, missing, of the wrong
            type or out of its range.
    """
    unknown = sorted(set(entries) - set(KNOWN))
    if unknown:
        raise ERROR(
            f"unknown entry {unknown[0]!r:.40}; there are {', '.join(KNOWN)}"
        )
    made: dict[str, list[Any]] = {}
    for name in LISTS:
        listed = entries.get(name, [])
        if not isinstance(listed, list):
            raise ERROR(f"{name} must be a list, got {listed!r:.40}")
        made[name] = [
            _build(name, number, e) for number, e in enumerate(listed, start=1)
        ]
    obstacles: list[Obstacle] = []
    for name in SOLIDS:
        obstacles += made[name]
    starts = None
    if "pursuer" in entries or "evader" in entries:
        for name in ("pursuer", "evader"):
            if name not in entries:
                raise ERROR(
                    "initial poses must be given for both players, "
                    f"got no {name}"
                )
        pursuer, evader = (_build(n, 0, entries[n]) for n in KNOWN[-2:])
        starts = (pursuer, evader)
    return Room(
        _number(entries, "width"),
        _number(entries, "depth"),
        tuple(obstacles),
        tuple(made["doors"]),
        starts,
        tuple(made["moving"]),
    )


def room_to_entries(room: Room) -> dict[str, Any]:
    """Return the entries of a file from which the room can be rebuilt."""
    entries: dict[str, Any] = {}
    if room.has_walls:
        entries |= {"width": room.width, "depth": room.depth}
    if room.starts is not None:
        for name, pose in zip(KNOWN[-2:], room.starts, strict=True):
            entries[name] = pose._asdict()
    for obstacle in room.obstacles:
        listed = entries.setdefault(LISTED[obstacle.kind], [])
        listed.append(asdict(obstacle))
    if room.doors:
        entries["doors"] = [asdict(door) for door in room.doors]
    if room.moving:
        entries["moving"] = [
            asdict(box) | {"to": list(box.to)} for box in room.moving
        ]
    return entries


def room_to_toml(room: Room) -> str:
    """Return the room as the text of a TOML file."""
    return tomli_w.dumps(room_to_entries(room))


def _pair(given: Any, name: str) -> tuple[float, float]:
    if not isinstance(given, list) or len(given) != 2:
        raise ERROR(f"{name} must be a pair x, y [m], got {given!r:.40}")
    return _real(given[0], f"{name} x"), _real(given[1], f"{name} y")


def _initial_pose(x: float, y: float, theta: float = 0.0) -> Pose:
    return Pose(x, y, theta)


# Constructors. Their parameters are the entries; those without a default
# are required.
_MAKERS: dict[str, Callable[..., Any]] = {
    "discs": Disc,
    "boxes": Box,
    "polygons": Polygon,
    "walls": wall_between,
    "doors": Door,
    "moving": MovingBox,
    "pursuer": _initial_pose,
    "evader": _initial_pose,
}


def _build(name: str, number: int, given: Any) -> Any:
    """Build one entry of a list; messages name the list and the number."""
    maker = _MAKERS[name]
    parameters = signature(maker).parameters.values()
    required = {p.name for p in parameters if p.default is p.empty}
    known = {p.name for p in parameters}
    label = f"{name} {number}" if number else name
    if not isinstance(given, dict):
        raise ERROR(f"{label} must be a table, got {given!r:.40}")
    missing = sorted(required - set(given))
    unknown = sorted(set(given) - known)
    if missing or unknown:
        wrong = f"no {missing[0]}" if missing else f"{unknown[0]!r:.40}"
        raise ERROR(
            f"{label} must have {', '.join(sorted(known))}, got {wrong}"
        )
    try:
        return maker(**{key: _parse(key, given[key]) for key in given})
    except ConfigurationError as error:
        raise ERROR(f"{label}: {error}") from error


def _parse(key: str, value: Any) -> Any:
    """Return the value of an entry: a pair, a number, or unchanged."""
    if key in ("start", "end", "to"):
        return _pair(value, key)
    return value if key in ("corners", "side") else _real(value, key)


def _number(entries: Mapping[str, Any], name: str) -> float | None:
    return _real(entries[name], name) if name in entries else None


def _real(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ERROR(f"{name} must be a number, got {value!r:.40}")
    try:
        return float(value)
    except OverflowError as error:
        raise ERROR(f"{name} must be a number, got one too large") from error
