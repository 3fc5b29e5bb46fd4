"""Phase of motion of a robot."""

from enum import Enum


class Phase(Enum):
    """Phase of motion of a robot, by its own estimate."""

    STANDING = "standing"
    WALKING = "walking"
    HALTING = "halting"
    FALLEN = "fallen"
