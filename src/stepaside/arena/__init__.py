"""Rooms: walls, discs, boxes and polygons on the floor."""

from .free_space import BODY_RADIUS, check_initial_poses, path_exists
from .moving_box import MovingBox
from .obstacles import (
    NO_OBSTACLES,
    Obstacle,
    ObstacleSet,
    clearance_between,
)
from .room import OPEN_FLOOR, Door, Room
from .room_file import (
    load_room,
    room_from_entries,
    room_to_entries,
    room_to_toml,
)
from .room_generation import (
    RoomRecipe,
    draw_any_start,
    draw_initial_poses,
    generate_room,
)
from .shapes import Box, Disc, Polygon, hull

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
    "check_initial_poses",
    "clearance_between",
    "draw_any_start",
    "draw_initial_poses",
    "path_exists",
    "hull",
    "load_room",
    "generate_room",
    "room_to_entries",
    "room_from_entries",
    "room_to_toml",
]
