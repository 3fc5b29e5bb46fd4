"""Rooms: walls, discs, boxes and polygons on the floor."""

from .moving_box import MovingBox
from .obstacles import (
    NO_OBSTACLES,
    Obstacle,
    ObstacleSet,
    clearance_between,
    obstacle_set,
)
from .reachability import path_exists
from .room import OPEN_FLOOR, Door, Room
from .room_file import load_room, room_entries, room_of_entries, room_text
from .room_generation import RoomRecipe, draw_starts, make_room
from .shapes import Box, Disc, Polygon, hull, wall_between
from .start_checks import BODY_RADIUS, check_starts

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
    "path_exists",
    "hull",
    "load_room",
    "make_room",
    "obstacle_set",
    "room_entries",
    "room_of_entries",
    "room_text",
    "wall_between",
]
