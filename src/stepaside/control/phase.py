"""What a robot is doing."""

from enum import Enum


class Phase(Enum):
    """What a robot is doing, as it knows itself."""

    STANDING = "standing"
    WALKING = "walking"
    HALTING = "halting"
    FALLEN = "fallen"
