"""Random rooms and initial poses, and the free space between."""

from dataclasses import replace
from itertools import combinations
from math import pi, radians, tau
from typing import Any

import numpy as np

from ..core.entries import to_entries
from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose
from ..core.random_streams import named_generator
from ..core.ranges import SEEDS
from .obstacles import Obstacle, clearance_between
from .room import BODY_RADIUS, FARTHEST, NEAREST, SIDES, Door, Room, RoomRecipe
from .shapes import Box, Disc, Polygon
from .shortest_path import first_waypoint

PLAYERS = ("pursuer", "evader")


def check_initial_poses(room: Room, starts: tuple[Pose, Pose]) -> None:
    """Check that initial poses of both are free and connected by a path."""
    radius = BODY_RADIUS
    for name, pose in zip(PLAYERS, starts, strict=True):
        place = f"({pose.x:g}, {pose.y:g})"
        clearance = float(room.clearance([pose[:2]])[0])
        for moving in room.moving:
            gap = float(moving.at(0.0).clearance([pose[:2]])[0])
            clearance = min(clearance, gap)
        if room.is_closed and not room.is_inside([pose[:2]])[0]:
            raise ConfigurationError(
                f"the {name} must start between the walls, within "
                f"{room.width:g} x {room.depth:g} [m], got {place}"
            )
        if not clearance >= radius - 1e-9:
            raise ConfigurationError(
                f"the {name} must start at least {radius:g} [m] from "
                f"obstacles and walls, got {clearance:.3g} at {place}"
            )
    distance = float(np.hypot(*np.subtract(starts[0][:2], starts[1][:2])))
    if distance < 2.0 * radius - 1e-9:
        raise ConfigurationError(
            f"the players must start at least {2 * radius:g} [m] apart, "
            f"got {distance:.3g}"
        )
    ends = starts[0][:2], starts[1][:2]
    if first_waypoint(room.solid_set, *ends, radius) is None:
        raise ConfigurationError(
            f"a path at least {2 * radius:g} [m] wide must connect the "
            "initial poses of pursuer and evader, got a room without one"
        )


def measure_room(room: Room) -> dict[str, Any]:
    """Measure a room, as a JSON object with the entries of its file."""
    gaps = (clearance_between(*pair) for pair in combinations(room.solids, 2))
    return {
        "obstacles": len(room.obstacles),
        "doors": len(room.doors),
        "closed": room.is_closed,
        "narrowest_gap_m": min((x for x in gaps if x > 1e-6), default=None),
        "room": to_entries(room),
    }


MAX_DRAWS = 2000  # of one obstacle, before a room counts as full
# Clearance of a body at its initial pose, in [m]: the radius of the tightest
# turn by (2).
TURN_CLEARANCE = 0.16


def generate_room(recipe: RoomRecipe, seed: int) -> Room:
    """Draw a random room of obstacles that do not overlap, with poses."""
    SEEDS.check(seed, "seed of a random room")
    random = named_generator(seed, "room")
    doors: list[Door] = []
    while len(doors) < recipe.doors:
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
    return replace(room, starts=draw_initial_poses(room, seed))


def draw_initial_poses(room: Room, seed: int) -> tuple[Pose, Pose]:
    """Draw initial poses of pursuer and evader in a room.

    They are 0.6 m to 1.5 m apart, the pursuer within 90 degrees of facing
    the evader, the evader within 30 degrees of facing the pursuer, with a
    free line of sight, a path, and clearance for the tightest turn by (2).
    """
    random, solids = named_generator(seed, "room starts"), room.solid_set
    radius = BODY_RADIUS
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
            or not solids.segments_keep_clear(0.0, both[:1], both[1:])[0]
        ):
            continue
        heading = sight + pi + evader_turn
        if heading > tau:  # poses of a room lie within one turn
            heading -= tau
        starts = (
            Pose(float(place[0]), float(place[1]), sight + pursuer_turn),
            Pose(float(other[0]), float(other[1]), heading),
        )
        ends = starts[0][:2], starts[1][:2]
        if first_waypoint(solids, *ends, radius) is not None:
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
