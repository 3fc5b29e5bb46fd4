"""Walls, objects and cameras of a game whose robots see images."""

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np

from ..robots.description import load_robot
from ..robots.head import HeadDescription, load_head
from .camera_settings import SceneSettings
from .floor import add_tiles
from .solid_geoms import add_geom

HIDDEN = 3  # geom group that only the cameras of robots render
HALF_WALL_HEIGHT = 1.2  # in [m]
WALL_MARGIN = 1.0  # smallest distance of a start from the walls, in [m]
WALL_DISTANCE = 3.5  # from a start to walls moved for it: camera range, [m]
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
    robot: str,
    *,
    walls: float,
    wearers: Sequence[str] = (),
) -> None:
    """Add walls, objects and the cameras of robots to a world.

    Walls are at a distance [m], 0 for none. The camera is added to the heads
    of the robots that use one, all of one kind, where the model lacks it.
    """
    head = load_head(load_robot(robot))
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


def wall_distance(walls: float, starts: Iterable[Sequence[float]]) -> float:
    """Return the distance of the walls from the origin, in [m].

    A player that began outside the walls would pass through one, undetected
    until then. If a start is not well inside, the walls are moved beyond the
    range of a depth camera at that start.
    """
    reach = max(abs(c) for start in starts for c in start[:2])
    if not walls or reach + WALL_MARGIN <= walls:
        return walls
    return reach + WALL_DISTANCE
