"""Rooms: walls, discs, boxes and polygons that stand on the floor."""

from .files import load_room, room_entries, room_of_entries, room_text
from .making import RoomRecipe, draw_starts, make_room
from .moving import MovingBox
from .obstacles import (
    NO_OBSTACLES,
    Obstacle,
    ObstacleSet,
    clearance_between,
    obstacle_set,
)
from .room import OPEN_FLOOR, Door, Room
from .shapes import Box, Disc, Polygon, hull, wall_between
from .starts import BODY_RADIUS, check_starts
from .ways import has_way

__all__ = [
    "BODY_RADIUS",
    "NO_OBSTACLES",
    "OPEN_FLOOR",
    "Box",
    "Disc",
    "Door",
    "MovingBox",
    "Obstacle",
    "ObstacleSet",
    "Polygon",
    "Room",
    "RoomRecipe",
    "check_starts",
    "clearance_between",
    "draw_starts",
    "has_way",
    "hull",
    "load_room",
    "make_room",
    "obstacle_set",
    "room_entries",
    "room_of_entries",
    "room_text",
    "wall_between",
]
