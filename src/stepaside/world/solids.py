"""The solids of a room, in MuJoCo: pillars, boxes and walls."""

from collections.abc import Callable

import mujoco
import numpy as np

from ..poses import Array
from ..rooms import Disc, Obstacle, Polygon, Room

FLOOR_BIT = 1  # as of the floor: robots run into it
HEIGHT = 0.6  # of all of them, a little above a NAO's head, in [m]
GREY = (0.54, 0.56, 0.60, 1.0)
BROWN = (0.60, 0.44, 0.28, 1.0)  # of what moves
PALE = (0.78, 0.79, 0.81, 1.0)  # of walls
SQUARE = 1e-9  # sum of cosines up to which corners are right angles


def add_solids(spec: mujoco.MjSpec, room: Room) -> None:
    """Put all that stands in a room into a world.

    Each is a body of its own, so that a contact has its name: "disc 1",
    "box 1", "polygon 1" and "wall 1", each counted from one.

    Args:
        spec: Specification of the world.
        room: The room; its frame is that of the world.
    """
    for name, solid in named_solids(room):
        colour = PALE if name.startswith("wall") else GREY
        _add_solid(spec, name, solid, colour)
    for number, box in enumerate(room.moving, start=1):
        _add_solid(spec, _name(number), box.at(0.0), BROWN, moves=True)


def mover_of(
    model: mujoco.MjModel, data: mujoco.MjData, room: Room
) -> Callable[[float], None]:
    """What puts the moving boxes of a room where they are at a time, in [s].

    Args:
        model: World that has them.
        data: Its state.
        room: The room.
    """
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
    """Whether a geom is a wall of a room that :func:`add_solids` put there."""
    name: str = model.body(int(model.geom_bodyid[geom])).name
    return name.startswith("wall ")


def named_solids(room: Room) -> tuple[tuple[str, Obstacle], ...]:
    """Solids of a room with the names of their bodies."""
    counts: dict[str, int] = {}
    named = []
    for number, solid in enumerate(room.solids):
        kind = "wall" if number >= len(room.obstacles) else _kind(solid)
        counts[kind] = counts.get(kind, 0) + 1
        named.append((f"{kind} {counts[kind]}", solid))
    return tuple(named)


def _kind(solid: Obstacle) -> str:
    if isinstance(solid, Disc):
        return "disc"
    return "polygon" if _sides(solid) is None else "box"


def _sides(polygon: Polygon) -> Array | None:
    """Edges of a box, in [m]; None for other polygons. Shape (4, 2)."""
    edges: Array = np.roll(polygon.points, -1, axis=0) - polygon.points
    after = np.roll(edges, -1, axis=0)
    right = bool((np.abs((edges * after).sum(axis=1)) < SQUARE).all())
    return edges if len(edges) == 4 and right else None


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
    look = {"rgba": list(colour), "contype": FLOOR_BIT, "conaffinity": 0}
    if isinstance(solid, Disc):
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=[0.0, 0.0, half],
            size=[solid.radius, half, 0.0],
            **look,
        )
        return
    edges = _sides(solid)
    if edges is not None:
        turn = 0.5 * float(np.arctan2(edges[0, 1], edges[0, 0]))
        length, depth = np.hypot(*edges[:2].T).tolist()
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=[0.0, 0.0, half],
            size=[0.5 * length, 0.5 * depth, half],
            quat=[float(np.cos(turn)), 0.0, 0.0, float(np.sin(turn))],
            **look,
        )
        return
    around = solid.points - solid.centre
    corners = [(*p, z) for p in around.tolist() for z in (0.0, HEIGHT)]
    mesh = spec.add_mesh(name=name)
    mesh.uservert = np.array(corners).ravel().tolist()
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        pos=[0.0, 0.0, 0.0],
        **look,
    )
