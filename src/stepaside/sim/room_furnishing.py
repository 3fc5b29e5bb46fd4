"""Geoms of walls, obstacles, objects and cameras in a room."""

from collections.abc import Callable, Sequence

import mujoco
import numpy as np

from ..arena import Box, Disc, Obstacle, Room
from ..robots.head import HeadDescription
from .camera_settings import SceneSettings
from .floor import add_geom, add_tiles

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


HIDDEN = 3  # geom group that only the cameras of robots render
HALF_WALL_HEIGHT = 1.2  # in [m]
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))
TONES = ((0.78, 0.76, 0.72), (0.70, 0.74, 0.74))
BOXES = {
    "red box": (0.78, 0.14, 0.12, 1.0),
    "blue box": (0.12, 0.34, 0.72, 1.0),
}
WHITE = (0.95, 0.95, 0.94, 1.0)
# Ellipsoids of a figure as tall as a NAO: position and half axes, in [m].
FIGURE = (
    ((0.0, 0.0, 0.50), (0.062, 0.066, 0.064)),
    ((0.0, 0.0, 0.35), (0.060, 0.080, 0.100)),
    ((0.0, 0.12, 0.35), (0.030, 0.030, 0.090)),
    ((0.0, -0.12, 0.35), (0.030, 0.030, 0.090)),
    ((0.0, 0.05, 0.14), (0.038, 0.038, 0.130)),
    ((0.0, -0.05, 0.14), (0.038, 0.038, 0.130)),
)


def add_scene(
    spec: mujoco.MjSpec,
    scene: SceneSettings,
    head: HeadDescription,
    *,
    walls: float,
    wearers: Sequence[str] = (),
) -> None:
    """Add walls, objects and the cameras of robots to a world.

    Walls are at a distance [m], 0 for none. The camera is added to the heads
    of the robots that use one, where the model lacks it.
    """
    if walls:
        _add_walls(spec, walls)
    for index, thing in enumerate(scene.things):
        body = spec.worldbody.add_body(
            name=f"thing {index}", pos=[thing.x, thing.y, 0.0]
        )
        _add_thing(body, thing.kind)
    for name in wearers:
        if spec.camera(f"{name}/{head.camera}") is None:
            _add_camera(spec, name, head)


def _add_camera(
    spec: mujoco.MjSpec, wearer: str, head: HeadDescription
) -> None:
    """Add the colour camera to a head; MuJoCo cameras look along -z."""
    mount = head.top
    forward, left, up = mount.axes_in_body.T
    axes = np.column_stack([-left, up, -forward])
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, axes.ravel())
    spec.body(f"{wearer}/{head.body}").add_camera(
        name=f"{wearer}/{head.camera}",
        pos=mount.position_in_body.tolist(),
        quat=turn.tolist(),
    )


def hide_walls(model: mujoco.MjModel) -> None:
    """Hide the walls in views from outside the room."""
    for x, y in SIDES:
        number = mujoco.mj_name2id(
            model, mujoco.mjtObj.mjOBJ_GEOM, _wall(x, y)
        )
        if number >= 0:
            model.geom_group[number] = HIDDEN


def _wall(x: int, y: int) -> str:
    return f"wall {x} {y}"


def _add_walls(spec: mujoco.MjSpec, distance: float) -> None:
    add_tiles(spec, "wall", TONES, 128, 1)
    for x, y in SIDES:
        across, along = 0.05 if x else distance, 0.05 if y else distance
        add_geom(
            spec.worldbody,
            "BOX",
            (across, along, HALF_WALL_HEIGHT),
            (0.5, 0.5, 0.5, 1.0),
            at=(x * distance, y * distance, HALF_WALL_HEIGHT),
            name=_wall(x, y),
            material="wall",
        )


def _add_thing(body: mujoco.MjsBody, kind: str) -> None:
    if kind in BOXES:
        add_geom(body, "BOX", (0.12, 0.12, 0.2), BOXES[kind], at=(0, 0, 0.2))
        return
    for place, size in FIGURE:
        add_geom(body, "ELLIPSOID", size, WHITE, at=place)
