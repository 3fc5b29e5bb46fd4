"""Room files: read from TOML or JSON, written as TOML."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import tomli_w

from ..core.entries import load_entries, read_entries, to_entries
from ..core.errors import AnyPath, ConfigurationError, as_path
from ..core.setting import check_settings, setting
from .moving_box import MovingBox
from .room import EXTENT, MAX_COUNT, Door, InitialPose, Room
from .shapes import Box, CentreLine, Disc, Polygon

LISTED = {"disc": "discs", "box": "boxes", "polygon": "polygons"}
COUNT = (0, MAX_COUNT)


@dataclass(frozen=True)
class RoomEntries:
    """Entries of a room file."""

    width: float | None = setting(None, "Width of the floor", EXTENT)
    depth: float | None = setting(None, "Depth of the floor", EXTENT)
    pursuer: InitialPose | None = setting(None, "Initial pose of the pursuer")
    evader: InitialPose | None = setting(None, "Initial pose of the evader")
    discs: tuple[Disc, ...] = setting((), "Discs", count=COUNT)
    boxes: tuple[Box, ...] = setting((), "Boxes", count=COUNT)
    polygons: tuple[Polygon, ...] = setting((), "Polygons", count=COUNT)
    walls: tuple[CentreLine, ...] = setting((), "Inner walls", count=COUNT)
    doors: tuple[Door, ...] = setting((), "Gaps in the walls", count=COUNT)
    moving: tuple[MovingBox, ...] = setting((), "Moving boxes", count=COUNT)

    def __post_init__(self) -> None:
        check_settings(self)
        if (self.pursuer is None) != (self.evader is None):
            missing = "evader" if self.evader is None else "pursuer"
            raise ConfigurationError(
                "initial poses must be given for both players, got no "
                f"{missing}"
            )

    @property
    def room(self) -> Room:
        """The room."""
        walls = (wall.box for wall in self.walls)
        starts = None
        if self.pursuer is not None and self.evader is not None:
            starts = self.pursuer.pose, self.evader.pose
        return Room(
            self.width,
            self.depth,
            (*self.discs, *self.boxes, *self.polygons, *walls),
            self.doors,
            starts,
            self.moving,
        )


def load_room(file: AnyPath) -> Room:
    """Read a room from a TOML file, or a JSON file with the suffix ".json"."""
    file = as_path(file, "file")
    entries = load_entries(file)
    try:
        return room_from_entries(entries)
    except ConfigurationError as error:
        raise ConfigurationError(f"room {file}: {error}") from error


def room_from_entries(entries: Mapping[str, Any]) -> Room:
    """Build a room from the entries of a file; see :class:`RoomEntries`."""
    return read_entries(RoomEntries, entries).room


def room_to_entries(room: Room) -> dict[str, Any]:
    """Return the entries of a file from which the room can be rebuilt."""
    entries: dict[str, Any] = {}
    if room.has_walls:
        entries |= {"width": room.width, "depth": room.depth}
    if room.starts is not None:
        pursuer, evader = map(to_entries, room.starts)
        entries |= {"pursuer": pursuer, "evader": evader}
    for obstacle in room.obstacles:
        listed = entries.setdefault(LISTED[obstacle.kind], [])
        listed.append(to_entries(obstacle))
    for name in ("doors", "moving"):
        if getattr(room, name):
            entries[name] = to_entries(getattr(room, name))
    return entries


def room_to_toml(room: Room) -> str:
    """Return the room as the text of a TOML file."""
    return tomli_w.dumps(room_to_entries(room))
