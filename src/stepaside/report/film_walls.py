"""Walls of a room that stand between a camera and what is in the room."""

from collections.abc import Iterator
from contextlib import contextmanager

import mujoco
import numpy as np

from ..core.poses import Array
from ..sim.obstacle_geoms import is_room_wall


def walls_before(model: mujoco.MjModel, eye: Array) -> list[int]:
    """Return the walls that are seen from outside the room.

    Args:
        model: Of the room, in the middle of which is the world's origin.
        eye: Place of the camera, in the world, in [m]. Shape (3,).

    Returns:
        Numbers of their geoms.
    """
    found = []
    for geom in range(model.ngeom):
        if not is_room_wall(model, geom):
            continue
        frame = np.zeros(9)
        mujoco.mju_quat2Mat(frame, model.geom_quat[geom])
        axes = frame.reshape(3, 3)
        place = model.body_pos[model.geom_bodyid[geom]]
        normal = axes[:, int(np.argmin(model.geom_size[geom][:2]))]
        # The room's middle and the camera lie on different sides of it.
        if (normal @ place) * (normal @ (place - eye)) < 0.0:
            found.append(geom)
    return found


@contextmanager
def see_through(model: mujoco.MjModel, eye: Array) -> Iterator[None]:
    """Hide the walls that a camera sees from outside, for one picture.

    Args:
        model: As of :func:`walls_before`.
        eye: Likewise.
    """
    walls = walls_before(model, eye)
    was = model.geom_rgba[walls, 3].copy()
    model.geom_rgba[walls, 3] = 0.0
    try:
        yield
    finally:
        model.geom_rgba[walls, 3] = was
