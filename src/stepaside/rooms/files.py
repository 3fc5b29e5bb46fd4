"""Rooms as files: TOML or JSON in, TOML out."""

import json
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

import tomli_w

from ..errors import AnyPath, ConfigurationError, as_path
from ..poses import Pose
from .built import WALL, box, wall_between
from .moving import MovingBox
from .room import Door, Obstacle, Room
from .shapes import Disc, Polygon

ERROR = ConfigurationError
LONGEST = 2**20  # text of a room, in [characters]
SOLIDS = ("discs", "boxes", "polygons", "walls")
LISTS = (*SOLIDS, "doors", "moving")
KNOWN = ("width", "depth", *LISTS, "pursuer", "evader")


def load_room(file: AnyPath) -> Room:
    """Read a room.

    Args:
        file: TOML, or JSON if its name ends so.

    Raises:
        ConfigurationError: If it is neither, or no room.
    """
    file = as_path(file, "file")
    try:
        with file.open("rb") as stream:
            text = stream.read(LONGEST + 1).decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ERROR(f"room {file}: {reason.lower()}") from error
    if len(text) > LONGEST:
        raise ERROR(f"room {file} must have at most {LONGEST} characters")
    read = json.loads if file.suffix.lower() == ".json" else tomllib.loads
    try:
        entries = read(text)
    except RecursionError as error:
        raise ERROR(f"room {file} is nested too deep") from error
    except ValueError as error:
        raise ERROR(f"room {file}: {error}") from error
    if not isinstance(entries, dict):
        raise ERROR(f"room {file} must hold one object, got {entries!r:.40}")
    try:
        return room_of_entries(entries)
    except ConfigurationError as error:
        raise ERROR(f"room {file}: {error}") from error


def room_of_entries(entries: Mapping[str, Any]) -> Room:
    """Turn entries of a file into a room.

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
    strange = sorted(set(entries) - set(KNOWN))
    if strange:
        raise ERROR(
            f"unknown entry {strange[0]!r:.40}; there are {', '.join(KNOWN)}"
        )
    made: dict[str, list[Any]] = {}
    for name in LISTS:
        listed = entries.get(name, [])
        if not isinstance(listed, list):
            raise ERROR(f"{name} must be a list, got {listed!r:.40}")
        made[name] = [
            _made(name, number, e) for number, e in _numbered(listed)
        ]
    obstacles: list[Obstacle] = []
    for name in SOLIDS:
        obstacles += made[name]
    starts = None
    if "pursuer" in entries or "evader" in entries:
        for name in ("pursuer", "evader"):
            if name not in entries:
                raise ERROR(f"a start must be that of both, got no {name}")
        pursuer, evader = (_made(n, 0, entries[n]) for n in KNOWN[-2:])
        starts = (pursuer, evader)
    return Room(
        _number(entries, "width"),
        _number(entries, "depth"),
        tuple(obstacles),
        tuple(made["doors"]),
        starts,
        tuple(made["moving"]),
    )


def room_entries(room: Room) -> dict[str, Any]:
    """Entries of a file that gives a room again."""
    entries: dict[str, Any] = {}
    if room.has_walls:
        entries |= {"width": room.width, "depth": room.depth}
    discs = [o for o in room.obstacles if isinstance(o, Disc)]
    polygons = [o for o in room.obstacles if isinstance(o, Polygon)]
    if room.starts is not None:
        for name, pose in zip(KNOWN[-2:], room.starts, strict=True):
            entries[name] = pose._asdict()
    if discs:
        entries["discs"] = [
            {"x": d.x, "y": d.y, "radius": d.radius} for d in discs
        ]
    if polygons:
        entries["polygons"] = [
            {"corners": [list(corner) for corner in p.corners]}
            for p in polygons
        ]
    if room.doors:
        entries["doors"] = [
            {"side": d.side, "at": d.at, "width": d.width} for d in room.doors
        ]
    if room.moving:
        entries["moving"] = [
            asdict(box) | {"to": list(box.to)} for box in room.moving
        ]
    return entries


def room_text(room: Room) -> str:
    """Text of a file, in TOML, that gives a room again."""
    return tomli_w.dumps(room_entries(room))


def _wall(start: Any, end: Any, thickness: float = WALL) -> Polygon:
    return wall_between(_pair(start, "start"), _pair(end, "end"), thickness)


def _moving(to: Any, **values: float) -> MovingBox:
    return MovingBox(to=_pair(to, "to"), **values)


def _pair(given: Any, name: str) -> tuple[float, float]:
    if not isinstance(given, list) or len(given) != 2:
        raise ERROR(f"{name} must be a pair x, y [m], got {given!r:.40}")
    return _real(given[0], f"{name} x"), _real(given[1], f"{name} y")


def _polygon(corners: Any) -> Polygon:
    return Polygon(corners)


# What makes each, which of its entries must be there, and which may.
_MAKERS: dict[str, tuple[Callable[..., Any], set[str], set[str]]] = {
    "discs": (Disc, {"x", "y", "radius"}, set()),
    "boxes": (box, {"x", "y", "width", "depth"}, {"heading"}),
    "polygons": (_polygon, {"corners"}, set()),
    "walls": (_wall, {"start", "end"}, {"thickness"}),
    "doors": (Door, {"side"}, {"at", "width"}),
    "moving": (
        _moving,
        {"x", "y", "width", "depth", "to"},
        {"speed", "heading"},
    ),
    "pursuer": (Pose, {"x", "y"}, {"theta"}),
    "evader": (Pose, {"x", "y"}, {"theta"}),
}
_NO_NUMBERS = ("corners", "start", "end", "side", "to")


def _made(name: str, number: int, given: Any) -> Any:
    """Make one thing of a list; messages say which."""
    maker, needed, allowed = _MAKERS[name]
    place = f"{name} {number}" if number else name
    if not isinstance(given, dict):
        raise ERROR(f"{place} must be a table, got {given!r:.40}")
    missing = sorted(needed - set(given))
    strange = sorted(set(given) - needed - allowed)
    if missing or strange:
        wrong = f"no {missing[0]}" if missing else f"{strange[0]!r:.40}"
        raise ERROR(
            f"{place} must have {', '.join(sorted(needed | allowed))}, "
            f"got {wrong}"
        )
    try:
        values = {
            key: value if key in _NO_NUMBERS else _real(value, key)
            for key, value in given.items()
        }
        if maker is Pose:
            values = {"theta": 0.0} | values
        return maker(**values)
    except ConfigurationError as error:
        raise ERROR(f"{place}: {error}") from error


def _numbered(listed: list[Any]) -> list[tuple[int, Any]]:
    return list(enumerate(listed, start=1))


def _number(entries: Mapping[str, Any], name: str) -> float | None:
    return _real(entries[name], name) if name in entries else None


def _real(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ERROR(f"{name} must be a number, got {value!r:.40}")
    try:
        return float(value)
    except OverflowError as error:
        raise ERROR(f"{name} must be a number, got one too long") from error
