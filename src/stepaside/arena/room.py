"""Rooms: walls with doors, obstacles and moving boxes; room files."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.entries import load_entries, read_entries
from ..core.errors import AnyPath, ConfigurationError, as_path, check_within
from ..core.poses import Array, Pose
from ..core.ranges import Range
from ..core.setting import REQUIRED, CheckedSettings, check_settings, setting
from .obstacles import Obstacle, ObstacleSet
from .shapes import BEARING, COORDINATE, WALL, Box, MovingBox

ERROR = ConfigurationError
Solids = tuple[Obstacle, ...]
SIDES = ("east", "north", "west", "south")
BODY_RADIUS = 0.20  # of a player among obstacles, in [m]
SMALLEST, LARGEST = 0.5, 100.0  # of a room, in [m]
MAX_COUNT = 500  # of obstacles, of doors and of moving boxes
EXTENT = Range(SMALLEST, LARGEST, "m", "from a cupboard to a hall")


@dataclass(frozen=True, slots=True)
class Door(CheckedSettings, prefix="door "):
    """Gap in a wall."""

    side: str = setting(
        REQUIRED,
        "Wall of the door: east is at positive x, north at positive y",
        names=SIDES,
    )
    at: float = setting(
        0.0,
        "Position of its middle along x or y, from the middle of the wall",
        COORDINATE,
    )
    width: float = setting(
        0.6, "Width", Range(0.05, LARGEST, "m", "to the largest wall")
    )


@dataclass(frozen=True)
class Room:
    """Room in its own frame: x along its width, y along its depth.

    The origin is in the middle. Walls stand around the floor, so all of
    width and depth is free. Without width and depth there are no walls.
    """

    width: float | None = setting(None, "Width of the floor, along x", EXTENT)
    depth: float | None = setting(None, "Depth of the floor, along y", EXTENT)
    obstacles: tuple[Obstacle, ...] = setting(
        (),
        "Obstacles at rest: discs, boxes and polygons, which may touch",
        count=(0, MAX_COUNT),
    )
    doors: tuple[Door, ...] = setting(
        (),
        "Gaps in the walls; the floor continues beyond them",
        count=(0, MAX_COUNT),
    )
    starts: tuple[Pose, Pose] | None = setting(
        None, "Initial poses of pursuer and evader in the room"
    )
    moving: tuple[MovingBox, ...] = setting(
        (), "Boxes that move back and forth", count=(0, MAX_COUNT)
    )

    def __post_init__(self) -> None:
        if (self.width is None) != (self.depth is None):
            raise ERROR("a room must have both width and depth, or neither")
        check_settings(self, prefix="room ")
        self._check_doors()
        ends = [place for box in self.moving for place in box.ends]
        for obstacle in (*self.obstacles, *ends):
            if self.has_walls and not self.is_inside([obstacle.centre])[0]:
                x, y = obstacle.centre
                raise ERROR(
                    "an obstacle must stand between the walls, within "
                    f"{self.width:g} x {self.depth:g} [m], "
                    f"got one at ({x:g}, {y:g})"
                )
        for pose in self.starts or ():
            for name, value in pose._asdict().items():
                limits = BEARING if name == "theta" else COORDINATE
                limits.check(value, f"start {name}")

    def _check_doors(self) -> None:
        if self.doors and not self.has_walls:
            raise ERROR("a room must have walls for its doors")
        for side in SIDES:
            length = self.depth if side in ("east", "west") else self.width
            low = -0.5 * (length or 0.0)
            for begin, end in self._gaps(side):
                if begin < low - 1e-9 or end > 0.5 * (length or 0.0) + 1e-9:
                    raise ERROR(
                        f"doors must lie in their wall and not overlap: "
                        f"{side} is {length:g} [m] long, got one from "
                        f"{begin:g} to {end:g}"
                    )
                low = end

    def _gaps(self, side: str) -> list[tuple[float, float]]:
        """Return begin and end of the doors of a side, in [m]."""
        return sorted(
            (door.at - 0.5 * door.width, door.at + 0.5 * door.width)
            for door in self.doors
            if door.side == side
        )

    @property
    def has_walls(self) -> bool:
        """Whether there are walls around it."""
        return self.width is not None

    @property
    def is_closed(self) -> bool:
        """Whether it has walls without doors."""
        return self.has_walls and not self.doors

    @cached_property
    def walls(self) -> tuple[Box, ...]:
        """Pieces of the walls, from door to door."""
        if self.width is None or self.depth is None:
            return ()
        pieces = []
        for side in SIDES:
            upright = side in ("east", "west")
            along = self.depth if upright else self.width
            away = 0.5 * ((self.width if upright else self.depth) + WALL)
            away = away if side in ("east", "north") else -away
            # The east and west walls include the corners.
            low = -0.5 * along - (WALL if upright else 0.0)
            for begin, end in [*self._gaps(side), (-low, -low)]:
                length, middle = begin - low, 0.5 * (begin + low)
                low = end
                if length < 1e-3:
                    continue
                if upright:
                    pieces.append(Box(away, middle, WALL, length))
                else:
                    pieces.append(Box(middle, away, length, WALL))
        return tuple(pieces)

    @property
    def solids(self) -> tuple[Obstacle, ...]:
        """Obstacles at rest, then walls."""
        return (*self.obstacles, *self.walls)

    def solids_at(self, time: float, ahead: float = 0.0) -> Solids:
        """Return the solids, and the floor that boxes cover for a time [s]."""
        end = time + ahead
        return (*self.solids, *(b.swept(time, end) for b in self.moving))

    def is_inside(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Return whether points (n, 2) lie between the walls; True without."""
        sides = (self.width or np.inf, self.depth or np.inf)
        inside: NDArray[np.bool_]
        inside = np.all(np.abs(points) <= 0.5 * np.array(sides), axis=1)
        return inside

    def clearance(self, points: ArrayLike) -> Array:
        """Return signed distances [m] of points (n, 2) to the nearest solid.

        They are inf on an open floor.
        """
        return self.solid_set.clearance(points)

    @cached_property
    def solid_set(self) -> ObstacleSet:
        """Obstacles at rest and walls, for distance queries."""
        return ObstacleSet(self.solids)


OPEN_FLOOR = Room()
"""Unbounded floor without obstacles."""


def load_room(file: AnyPath) -> Room:
    """Read a room from a TOML file, or a JSON file with the suffix ".json"."""
    file = as_path(file, "file")
    entries = load_entries(file)
    try:
        return read_entries(Room, entries)
    except ConfigurationError as error:
        raise ConfigurationError(f"room {file}: {error}") from error


NUMBER = Range(0, MAX_COUNT, "1", "more take too long", whole=True)
SIDE = Range(SMALLEST, LARGEST, "m", "of a room", also=(None,))
RADIUS = Range(0.01, LARGEST, "m", "from a post to the largest room")
NEAREST, FARTHEST = 0.6, 1.5  # initial distance, as in a duel, in [m]


@dataclass(frozen=True, slots=True)
class RoomRecipe:
    """Size of random rooms and number of obstacles in them."""

    width: float | None = setting(
        3.0, "Width of the floor, along x; none for no walls", SIDE
    )
    depth: float | None = setting(
        3.0, "Depth of the floor, along y; none for no walls", SIDE
    )
    discs: int = setting(0, "Number of discs", NUMBER)
    boxes: int = setting(0, "Number of boxes", NUMBER)
    polygons: int = setting(
        0,
        "Number of polygons with three to six corners",
        NUMBER,
    )
    doors: int = setting(0, "Number of doors in the walls", NUMBER)
    smallest: float = setting(0.1, "Minimum radius of an obstacle", RADIUS)
    largest: float = setting(
        0.25,
        "Maximum radius of an obstacle, of its circumcircle for boxes and "
        "polygons",
        RADIUS,
    )
    door_width: float = setting(
        0.6,
        "Width of a door",
        Range(SMALLEST / 2, LARGEST, "m", "from a body to the largest room"),
    )

    def __post_init__(self) -> None:
        check_settings(self)
        Room(self.width, self.depth)
        least = self.smallest
        check_within(self.largest, least, LARGEST, "largest", "m", ERROR)
        if self.doors and self.width is None:
            raise ERROR("a room must have walls for its doors")

    @property
    def floor(self) -> tuple[float, float]:
        """Sides of the floor that obstacles are drawn on, in [m]."""
        return self.width or 2 * FARTHEST, self.depth or 2 * FARTHEST
