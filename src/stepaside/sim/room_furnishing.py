"""Bodies of the obstacles and walls of a room."""

from collections.abc import Callable

import mujoco
import numpy as np

from ..arena import Box, Disc, Obstacle, Room
from .solid_geoms import add_geom

HEIGHT = 0.6  # of all obstacles, a little above a NAO's head, in [m]
GREY = (0.54, 0.56, 0.60, 1.0)
BROWN = (0.60, 0.44, 0.28, 1.0)  # of moving boxes
PALE = (0.78, 0.79, 0.81, 1.0)  # of walls


def add_solids(spec: mujoco.MjSpec, room: Room) -> None:
    """Add obstacles and walls, each a body: "disc 1", "wall 1" and so on."""
    for name, solid in named_solids(room):
        colour = PALE if name.startswith("wall") else GREY
        _add_solid(spec, name, solid, colour)
    for number, box in enumerate(room.moving, start=1):
        _add_solid(spec, _name(number), box.at(0.0), BROWN, moves=True)


def obstacle_mover(
    model: mujoco.MjModel, data: mujoco.MjData, room: Room
) -> Callable[[float], None]:
    """Return the function of time, in [s], that moves the moving boxes."""
    numbers = [
        int(model.body(_name(number)).mocapid[0])
        for number in range(1, len(room.moving) + 1)
    ]

    def move(time: float) -> None:
        for number, box in zip(numbers, room.moving, strict=True):
            data.mocap_pos[number, :2] = box.place_at(time)

    return move


def _name(number: int) -> str:
    return f"moving box {number}"


def is_room_wall(model: mujoco.MjModel, geom: int) -> bool:
    """Return whether :func:`add_solids` added a geom as a wall."""
    name: str = model.body(int(model.geom_bodyid[geom])).name
    return name.startswith("wall ")


def named_solids(room: Room) -> tuple[tuple[str, Obstacle], ...]:
    """Return the obstacles and walls of a room with their body names."""
    counts: dict[str, int] = {}
    named = []
    for number, solid in enumerate(room.solids):
        kind = "wall" if number >= len(room.obstacles) else solid.kind
        counts[kind] = counts.get(kind, 0) + 1
        named.append((f"{kind} {counts[kind]}", solid))
    return tuple(named)


def _add_solid(
    spec: mujoco.MjSpec,
    name: str,
    solid: Obstacle,
    colour: tuple[float, ...],
    *,
    moves: bool = False,
) -> None:
    x, y = solid.centre
    body = spec.worldbody.add_body(name=name, pos=[x, y, 0.0], mocap=moves)
    half = 0.5 * HEIGHT
    if isinstance(solid, Disc):
        size = solid.radius, half
        add_geom(body, "CYLINDER", size, colour, at=(0.0, 0.0, half))
    elif isinstance(solid, Box):
        size3 = 0.5 * solid.width, 0.5 * solid.depth, half
        at, yaw = (0.0, 0.0, half), solid.heading
        add_geom(body, "BOX", size3, colour, at=at, yaw=yaw)
    else:
        around = solid.points - solid.centre
        corners = [(*p, z) for p in around.tolist() for z in (0.0, HEIGHT)]
        spec.add_mesh(name=name).uservert = np.array(corners).ravel().tolist()
        add_geom(body, "MESH", (), colour, meshname=name)
