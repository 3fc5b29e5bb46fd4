"""Rooms by seed: how large, with how much in them."""

from dataclasses import dataclass
from math import pi, radians, tau

import numpy as np

from ..core.errors import ConfigurationError, check_within
from ..core.poses import Array, Pose
from ..core.random_streams import named_generator
from .obstacles import Obstacle, clearance_between
from .polygon_checks import check_coordinate
from .reachability import has_way
from .room import LARGEST, MOST, SIDES, SMALLEST, Door, Room
from .shapes import Box, Disc, Polygon
from .start_checks import BODY_RADIUS

ERROR = ConfigurationError
TRIES = 2000  # at one draw, before a room counts as full
CLEAR = 0.16  # of a body at its start, to turn away from anything, [m]
NEAREST, FARTHEST = 0.6, 1.5  # from pursuer to evader, as in a duel, [m]


@dataclass(frozen=True, slots=True)
class RoomRecipe:
    """What a seed makes a room of.

    Attributes:
        width: Of the floor, along x, in [m]; None for no walls.
        depth: Of the floor, along y, in [m]; None for no walls.
        discs: How many discs stand in it.
        boxes: How many boxes.
        polygons: How many polygons of three to six corners.
        doors: How many doors its walls have.
        smallest: Least radius of an obstacle, in [m]; of boxes and
            polygons that of the circle around them.
        largest: Largest radius, likewise.
        door_width: In [m].
    """

    width: float | None = 3.0
    depth: float | None = 3.0
    discs: int = 0
    boxes: int = 0
    polygons: int = 0
    doors: int = 0
    smallest: float = 0.1
    largest: float = 0.25
    door_width: float = 0.6

    def __post_init__(self) -> None:
        """Refuse what makes no room."""
        Room(self.width, self.depth)
        for name in ("discs", "boxes", "polygons", "doors"):
            value = getattr(self, name)
            if type(value) is not int:
                raise ERROR(f"{name} must be an integer [1], got {value!r}")
            check_within(value, 0, MOST, name, "1", ERROR)
        check_within(self.smallest, 0.01, LARGEST, "smallest", "m", ERROR)
        check_within(
            self.largest, self.smallest, LARGEST, "largest", "m", ERROR
        )
        check_within(
            self.door_width, SMALLEST / 2, LARGEST, "door_width", "m", ERROR
        )
        if self.doors and self.width is None:
            raise ERROR("a room must have walls for its doors")

    @property
    def floor(self) -> tuple[float, float]:
        """Where obstacles stand, of a room or of an open floor, in [m]."""
        return self.width or 2 * FARTHEST, self.depth or 2 * FARTHEST


def make_room(recipe: RoomRecipe, seed: int) -> Room:
    """Make the room of a seed, with starts in it.

    Obstacles do not overlap. The players start as far apart and as turned
    as in a duel, see each other, and have a way to each other.

    Args:
        recipe: What it is made of.
        seed: Seed of the draws.

    Raises:
        ConfigurationError: If there is no place for all of it.
    """
    random = named_generator(seed, "room")
    doors: list[Door] = []
    for _ in range(recipe.doors):
        doors.append(_draw_door(recipe, doors, random))
    obstacles: list[Obstacle] = []
    kinds = (
        [_disc] * recipe.discs
        + [_box] * recipe.boxes
        + [_polygon] * recipe.polygons
    )
    for kind in kinds:
        for _ in range(TRIES):
            radius = random.uniform(recipe.smallest, recipe.largest)
            x, y = (
                random.uniform(-1.0, 1.0) * (0.5 * side - radius)
                for side in recipe.floor
            )
            made = kind(x, y, radius, random)
            around = Disc(x, y, radius)
            inside = all(
                abs(at) + radius <= 0.5 * side
                for at, side in zip((x, y), recipe.floor, strict=True)
            )
            if inside and not any(
                clearance_between(o, around) < 0.0 for o in obstacles
            ):
                obstacles.append(made)
                break
        else:
            raise _full(recipe, f"{len(kinds)} obstacles")
    room = Room(recipe.width, recipe.depth, tuple(obstacles), tuple(doors))
    starts = draw_starts(room, seed)
    return Room(room.width, room.depth, room.obstacles, room.doors, starts)


def draw_starts(
    room: Room, seed: int, radius: float = BODY_RADIUS
) -> tuple[Pose, Pose]:
    """Draw where pursuer and evader start in a room.

    Args:
        room: The room.
        seed: Seed of the draws.
        radius: Of their bodies, in [m]; they start 16 cm further from
            everything, the radius of the tightest turn by (2).

    Returns:
        Poses of pursuer and evader in the room: 0.6 m to 1.5 m apart, the
        pursuer within 90 degrees of facing the evader, the evader within
        30 degrees of facing the pursuer, in each other's sight.

    Raises:
        ConfigurationError: If no place is found for them.
    """
    random = named_generator(seed, "room starts")
    half = 0.5 * np.array([room.width or 0.0, room.depth or 0.0])
    for _ in range(TRIES):
        place = half * random.uniform(-1.0, 1.0, 2)
        sight = random.uniform(-pi, pi)
        apart = random.uniform(NEAREST, FARTHEST)
        pursuer_turn = random.uniform(-pi / 2, pi / 2)
        evader_turn = random.uniform(-radians(30.0), radians(30.0))
        other: Array = place + apart * np.array([np.cos(sight), np.sin(sight)])
        both = np.stack([place, other])
        if (
            room.clearance(both).min() < radius + CLEAR
            or not room.is_inside(both).all()
            or not room.sees(both[:1], both[1:])[0]
        ):
            continue
        facing = sight + pi + evader_turn
        if facing > tau:  # headings of initial poses lie within one turn
            facing -= tau
        starts = (
            Pose(float(place[0]), float(place[1]), sight + pursuer_turn),
            Pose(float(other[0]), float(other[1]), facing),
        )
        if has_way(room, starts[0][:2], starts[1][:2], radius):
            return starts
    raise ConfigurationError(
        f"a room must have place for two players of radius {radius:g} [m], "
        f"{NEAREST:g} to {FARTHEST:g} apart, got one that is too full"
    )


def _disc(x: float, y: float, r: float, random: np.random.Generator) -> Disc:
    return Disc(x, y, r)


def _box(x: float, y: float, r: float, random: np.random.Generator) -> Box:
    half = random.uniform(radians(25.0), radians(65.0))  # of its diagonal
    heading = random.uniform(-pi, pi)
    width, depth = 2 * r * np.cos(half), 2 * r * np.sin(half)
    return Box(x, y, float(width), float(depth), heading)


def _polygon(
    x: float, y: float, r: float, random: np.random.Generator
) -> Polygon:
    count = int(random.integers(3, 7))
    # Corners on the circle, no two of which are close to each other.
    angles = np.arange(count) + random.uniform(-0.3, 0.3, count)
    angles = 2 * pi * angles / count + random.uniform(-pi, pi)
    ring = np.stack([x + r * np.cos(angles), y + r * np.sin(angles)], axis=-1)
    return Polygon(tuple((a, b) for a, b in ring.tolist()))


def _draw_door(
    recipe: RoomRecipe, doors: list[Door], random: np.random.Generator
) -> Door:
    for _ in range(TRIES):
        side = SIDES[random.integers(len(SIDES))]
        along = recipe.depth if side in ("east", "west") else recipe.width
        room = 0.5 * ((along or 0.0) - recipe.door_width)
        if room < 0.0:
            continue
        door = Door(side, room * random.uniform(-1.0, 1.0), recipe.door_width)
        check_coordinate(door.at, "door at")
        if all(
            other.side != side or abs(other.at - door.at) > recipe.door_width
            for other in doors
        ):
            return door
    raise _full(recipe, f"{recipe.doors} doors")


def _full(recipe: RoomRecipe, what: str) -> ConfigurationError:
    width, depth = recipe.floor
    return ConfigurationError(
        f"a room of {width:g} x {depth:g} [m] must have place for {what}, "
        "got one that is too full"
    )
