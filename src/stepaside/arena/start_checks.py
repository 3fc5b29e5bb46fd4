"""Whether two players can stand, and meet, where they shall start."""

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from .reachability import has_way
from .room import Room

BODY_RADIUS = 0.20  # of a player among obstacles, in [m]
PLAYERS = ("pursuer", "evader")


def check_starts(
    room: Room, starts: tuple[Pose, Pose], radius: float = BODY_RADIUS
) -> None:
    """Refuse starts in an obstacle, or between which there is no way.

    Args:
        room: The room.
        starts: Poses of pursuer and evader in the room.
        radius: Of their bodies, in [m].

    Raises:
        ConfigurationError: If one overlaps something, both overlap each
            other, or neither can come to the other.
    """
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
    apart = float(np.hypot(*np.subtract(starts[0][:2], starts[1][:2])))
    if apart < 2.0 * radius - 1e-9:
        raise ConfigurationError(
            f"the players must start at least {2 * radius:g} [m] apart, "
            f"got {apart:.3g}"
        )
    if not has_way(room, starts[0][:2], starts[1][:2], radius):
        raise ConfigurationError(
            f"there must be a way of {2 * radius:g} [m] between the starts "
            "of pursuer and evader, got a room without one"
        )
