"""A room: walls around it, doors in them, and what stands in it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.errors import ConfigurationError, check_bearing, check_within
from ..core.poses import Array, Pose
from .moving_box import MovingBox
from .obstacles import Obstacle, ObstacleSet
from .polygon_checks import check_coordinate
from .shapes import WALL, Box

ERROR = ConfigurationError
Solids = tuple[Obstacle, ...]
SIDES = ("east", "north", "west", "south")
KINDS = ("disc", "box", "polygon")  # of obstacles, in the order of files
SMALLEST, LARGEST = 0.5, 100.0  # of a room, in [m]
MOST = 500  # obstacles, doors


@dataclass(frozen=True, slots=True)
class Door:
    """A gap in a wall.

    Attributes:
        side: Wall that it is in: "east" is at positive x, "north" at
            positive y.
        at: Where its middle is, from the middle of the wall, in [m],
            positive in the direction of x or of y.
        width: In [m].
    """

    side: str
    at: float = 0.0
    width: float = 0.6

    def __post_init__(self) -> None:
        """Refuse other sides, and what is not finite."""
        if self.side not in SIDES:
            raise ERROR(
                f"door side must be one of {', '.join(SIDES)}, "
                f"got {self.side!r:.40}"
            )
        check_coordinate(self.at, "door at")
        check_within(self.width, 0.05, LARGEST, "door width", "m", ERROR)


@dataclass(frozen=True)
class Room:
    """A room in its own frame: x along its width, y along its depth.

    The origin is in the middle. Walls stand around the floor, so all of
    width and depth is free. Without both there are no walls.

    Attributes:
        width: Of the floor, along x, in [m]; None for no walls.
        depth: Of the floor, along y, in [m]; None for no walls.
        obstacles: What stands in it; obstacles may touch each other. Kept as
            files have them: discs, then boxes, then polygons.
        doors: Gaps in the walls, beyond which the floor goes on.
        starts: Where pursuer and evader stand at first, if it says so.
        moving: Boxes that are pushed to and fro in it.
    """

    width: float | None = None
    depth: float | None = None
    obstacles: tuple[Obstacle, ...] = ()
    doors: tuple[Door, ...] = ()
    starts: tuple[Pose, Pose] | None = None
    moving: tuple[MovingBox, ...] = ()

    def __post_init__(self) -> None:
        """Refuse sizes, doors and obstacles that are not of a room."""
        if (self.width is None) != (self.depth is None):
            raise ERROR("a room must have both width and depth, or neither")
        for name in ("width", "depth"):
            value = getattr(self, name)
            if value is not None:
                check_within(
                    value, SMALLEST, LARGEST, f"room {name}", "m", ERROR
                )
        for what in ("obstacles", "doors", "moving"):
            count = len(getattr(self, what))
            if count > MOST:
                raise ERROR(
                    f"a room must have at most {MOST} {what} [1], got {count}"
                )
        self._check_doors()
        ordered = sorted(self.obstacles, key=lambda o: KINDS.index(o.kind))
        object.__setattr__(self, "obstacles", tuple(ordered))
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
            check_coordinate(pose.x, "start x")
            check_coordinate(pose.y, "start y")
            check_bearing(pose.theta, "start theta", ERROR)

    def _check_doors(self) -> None:
        if self.doors and not self.has_walls:
            raise ERROR("a room must have walls for its doors")
        for side in SIDES:
            length = self.depth if side in ("east", "west") else self.width
            ends = sorted(
                (door.at - 0.5 * door.width, door.at + 0.5 * door.width)
                for door in self.doors
                if door.side == side
            )
            low = -0.5 * (length or 0.0)
            for begin, end in ends:
                if begin < low - 1e-9 or end > 0.5 * (length or 0.0) + 1e-9:
                    raise ERROR(
                        f"doors must lie in their wall and not overlap: "
                        f"{side} is {length:g} [m] long, got one from "
                        f"{begin:g} to {end:g}"
                    )
                low = end

    @property
    def has_walls(self) -> bool:
        """Whether there are walls around it."""
        return self.width is not None

    @property
    def is_closed(self) -> bool:
        """Whether nobody gets out."""
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
            # Those to the east and west reach around the corners.
            low = -0.5 * along - (WALL if upright else 0.0)
            gaps = sorted(
                (door.at - 0.5 * door.width, door.at + 0.5 * door.width)
                for door in self.doors
                if door.side == side
            )
            for begin, end in [*gaps, (-low, -low)]:
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
        """All that nobody can walk through: obstacles, then walls."""
        return (*self.obstacles, *self.walls)

    def solids_at(self, time: float, ahead: float = 0.0) -> Solids:
        """Solids, and the floor that boxes cover which are pushed about.

        Args:
            time: Time, in [s].
            ahead: For how long from then on, in [s].
        """
        end = time + ahead
        return (*self.solids, *(b.swept(time, end) for b in self.moving))

    def is_inside(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether points lie between the walls; all do without. (n,)."""
        asked = np.asarray(points, dtype=np.float64)
        if self.width is None or self.depth is None:
            return np.ones(len(asked), dtype=np.bool_)
        half = 0.5 * np.array([self.width, self.depth])
        found: NDArray[np.bool_] = np.all(np.abs(asked) <= half, axis=1)
        return found

    def clearance(self, points: ArrayLike) -> Array:
        """Distance of points to the nearest solid, in [m].

        Args:
            points: Points (x, y) in the room, in [m]. Shape (n, 2).

        Returns:
            Signed distances: negative inside a solid and beyond the walls
            of a closed room, infinite on a floor without anything. Shape
            (n,).
        """
        asked = np.asarray(points, dtype=np.float64)
        known = self._obstacle_set if self.is_closed else self._solid_set
        found = known.clearance(asked)
        if self.is_closed:
            half = 0.5 * np.array([self.width, self.depth])
            np.minimum(found, (half - np.abs(asked)).min(axis=1), out=found)
        return found

    def sees(self, starts: ArrayLike, ends: ArrayLike) -> NDArray[np.bool_]:
        """Whether nothing stands between points.

        Args:
            starts: Points (x, y) in the room, in [m]. Shape (n, 2).
            ends: Other points, likewise.

        Returns:
            Whether the line between each two touches no solid. Shape (n,).
        """
        hidden: NDArray[np.bool_]
        hidden = np.any(self._solid_set.crossed(starts, ends), axis=1)
        return ~hidden

    @cached_property
    def _obstacle_set(self) -> ObstacleSet:
        return ObstacleSet(self.obstacles)

    @cached_property
    def _solid_set(self) -> ObstacleSet:
        return ObstacleSet(self.solids)


OPEN_FLOOR = Room()
"""A floor without end on which nothing stands."""
