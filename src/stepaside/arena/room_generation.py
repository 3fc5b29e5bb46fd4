"""Random rooms and random initial poses in a room."""

from dataclasses import dataclass
from math import pi, radians, tau

import numpy as np

from ..core.errors import ConfigurationError, check_within
from ..core.poses import Array, Pose
from ..core.random_streams import named_generator
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from .free_space import BODY_RADIUS, path_exists
from .obstacles import Obstacle, clearance_between
from .room import LARGEST, MAX_COUNT, SIDES, SMALLEST, Door, Room
from .shapes import Box, Disc, Polygon

ERROR = ConfigurationError
MAX_DRAWS = 2000  # of one obstacle, before a room counts as full
# Clearance of a body at its initial pose, in [m]: the radius of the tightest
# turn by (2).
TURN_CLEARANCE = 0.16
COUNT = Range(0, MAX_COUNT, "1", "more take too long", whole=True)
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
    discs: int = setting(0, "Number of discs", COUNT)
    boxes: int = setting(0, "Number of boxes", COUNT)
    polygons: int = setting(
        0,
        "Number of polygons with three to six corners",
        COUNT,
    )
    doors: int = setting(0, "Number of doors in the walls", COUNT)
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


def generate_room(recipe: RoomRecipe, seed: int) -> Room:
    """Draw a random room of obstacles that do not overlap, with poses."""
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
        for _ in range(MAX_DRAWS):
            radius = random.uniform(recipe.smallest, recipe.largest)
            x, y = (
                random.uniform(-1.0, 1.0) * (0.5 * side - radius)
                for side in recipe.floor
            )
            made = kind(x, y, radius, random)
            around = Disc(x, y, radius)
            inside = radius <= 0.5 * min(recipe.floor)
            if inside and all(
                clearance_between(o, around) >= 0.0 for o in obstacles
            ):
                obstacles.append(made)
                break
        else:
            raise _full(recipe, f"{len(kinds)} obstacles")
    room = Room(recipe.width, recipe.depth, tuple(obstacles), tuple(doors))
    starts = draw_initial_poses(room, seed)
    return Room(room.width, room.depth, room.obstacles, room.doors, starts)


def draw_initial_poses(
    room: Room, seed: int, radius: float = BODY_RADIUS
) -> tuple[Pose, Pose]:
    """Draw initial poses of pursuer and evader in a room.

    They are 0.6 m to 1.5 m apart, the pursuer within 90 degrees of facing
    the evader, the evader within 30 degrees of facing the pursuer, with a
    free line of sight, a path, and clearance for the tightest turn by (2).
    """
    random = named_generator(seed, "room starts")
    half = 0.5 * np.array([room.width or 0.0, room.depth or 0.0])
    for _ in range(MAX_DRAWS):
        place = half * random.uniform(-1.0, 1.0, 2)
        sight = random.uniform(-pi, pi)
        apart = random.uniform(NEAREST, FARTHEST)
        pursuer_turn = random.uniform(-pi / 2, pi / 2)
        evader_turn = random.uniform(-radians(30.0), radians(30.0))
        other: Array = place + apart * np.array([np.cos(sight), np.sin(sight)])
        both = np.stack([place, other])
        if (
            room.clearance(both).min() < radius + TURN_CLEARANCE
            or not room.is_inside(both).all()
            or not room.sees(both[:1], both[1:])[0]
        ):
            continue
        heading = sight + pi + evader_turn
        if heading > tau:  # poses of a room lie within one turn
            heading -= tau
        starts = (
            Pose(float(place[0]), float(place[1]), sight + pursuer_turn),
            Pose(float(other[0]), float(other[1]), heading),
        )
        if path_exists(room, starts[0][:2], starts[1][:2], radius):
            return starts
    raise ConfigurationError(
        f"a room must have space for two players of radius {radius:g} [m], "
        f"{NEAREST:g} to {FARTHEST:g} [m] apart, got one that is too full"
    )


def draw_any_start(seed: int) -> tuple[Pose, Pose]:
    """Draw poses of any headings on an open floor, 0.6 to 1.5 m apart."""
    random = named_generator(seed, "any start")
    apart = random.uniform(NEAREST, FARTHEST)
    chase, flight = random.uniform(-pi, pi, 2).tolist()
    return Pose(0.0, 0.0, chase), Pose(apart, 0.0, flight)


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
    # Corners on the circle, at least 0.4 of an equal spacing apart.
    angles = np.arange(count) + random.uniform(-0.3, 0.3, count)
    angles = 2 * pi * angles / count + random.uniform(-pi, pi)
    ring = np.stack([x + r * np.cos(angles), y + r * np.sin(angles)], axis=-1)
    return Polygon(tuple((a, b) for a, b in ring.tolist()))


def _draw_door(
    recipe: RoomRecipe, doors: list[Door], random: np.random.Generator
) -> Door:
    for _ in range(MAX_DRAWS):
        side = SIDES[random.integers(len(SIDES))]
        along = recipe.depth if side in ("east", "west") else recipe.width
        reach = 0.5 * ((along or 0.0) - recipe.door_width)
        if reach < 0.0:
            continue
        door = Door(side, reach * random.uniform(-1.0, 1.0), recipe.door_width)
        if all(
            other.side != side or abs(other.at - door.at) > recipe.door_width
            for other in doors
        ):
            return door
    raise _full(recipe, f"{recipe.doors} doors")


def _full(recipe: RoomRecipe, what: str) -> ConfigurationError:
    width, depth = recipe.floor
    return ConfigurationError(
        f"a room of {width:g} x {depth:g} [m] must have space for {what}, "
        "got one that is too full"
    )
