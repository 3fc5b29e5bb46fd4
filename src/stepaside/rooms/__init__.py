"""Rooms: walls, discs, boxes and polygons that stand on the floor."""

from .built import box, hull, wall_between
from .distance import clearance_between, crosses
from .files import load_room, room_entries, room_of_entries, room_text
from .making import RoomRecipe, draw_starts, make_room
from .moving import MovingBox
from .room import OPEN_FLOOR, Door, Obstacle, Room
from .shapes import Disc, Polygon
from .starts import BODY_RADIUS, check_starts
from .ways import has_way

__all__ = [
    "BODY_RADIUS",
    "OPEN_FLOOR",
    "Disc",
    "Door",
    "MovingBox",
    "Obstacle",
    "Polygon",
    "Room",
    "RoomRecipe",
    "box",
    "check_starts",
    "clearance_between",
    "crosses",
    "draw_starts",
    "has_way",
    "hull",
    "load_room",
    "make_room",
    "room_entries",
    "room_of_entries",
    "room_text",
    "wall_between",
]
