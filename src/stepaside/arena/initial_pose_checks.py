"""Validation of initial poses in a room."""

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Pose
from .reachability import path_exists
from .room import Room

BODY_RADIUS = 0.20  # of a player among obstacles, in [m]
PLAYERS = ("pursuer", "evader")


def check_initial_poses(
    room: Room, starts: tuple[Pose, Pose], radius: float = BODY_RADIUS
) -> None:
    """Check that initial poses are free and connected by a path.

    Args:
        room: The room.
        starts: Initial poses of pursuer and evader in the room.
        radius: Radius of their bodies, in [m].

    Raises:
        ConfigurationError: If a body overlaps an obstacle or a wall, the
            bodies overlap each other, or no path connects them.
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
    distance = float(np.hypot(*np.subtract(starts[0][:2], starts[1][:2])))
    if distance < 2.0 * radius - 1e-9:
        raise ConfigurationError(
            f"the players must start at least {2 * radius:g} [m] apart, "
            f"got {distance:.3g}"
        )
    if not path_exists(room, starts[0][:2], starts[1][:2], radius):
        raise ConfigurationError(
            f"a path at least {2 * radius:g} [m] wide must connect the "
            "initial poses of pursuer and evader, got a room without one"
        )
