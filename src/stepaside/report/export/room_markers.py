"""Obstacles, persons and templates of a run as shapes over time."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ...core.poses import Array
from ...games.run import Run
from ..scene import RunScene
from ..visual_geoms import MAX_VISIBLE_GROUP
from .bag_messages import MessageFactory
from .recorded_transforms import quaternion_of

PERIOD = 0.1  # between poses of shapes that move, in [s]
_GEOMS = mujoco.mjtGeom


class RoomShape(NamedTuple):
    """Shape that does not belong to a robot.

    Attributes:
        geom: Index of the geom in the model of the scene.
        kind: "CUBE", "SPHERE" or "CYLINDER".
        size: Full lengths along its axes, in [m].
        colour: Red, green, blue, opacity, 0 to 1.
        owner: Name of its player, or "room".
    """

    geom: int
    kind: str
    size: tuple[float, float, float]
    colour: tuple[float, float, float, float]
    owner: str


class PlacedShape(NamedTuple):
    """Shape with its pose in the world.

    Attributes:
        number: Index of the shape in the list of all.
        shape: The shape.
        position: Position, in [m]. Shape (3,).
        quaternion: Rotation (w, x, y, z). Shape (4,).
    """

    number: int
    shape: RoomShape
    position: Array
    quaternion: Array


def shapes_over_time(run: Run) -> Iterator[tuple[float, list[PlacedShape]]]:
    """Yield times, in [s], with the shapes that moved since the last.

    The first entry has all shapes; nothing is yielded without shapes.

    Args:
        run: The run.
    """
    scene = RunScene(run)
    model, data = scene.model, scene.data
    shapes = list(_shapes_of(model, run))
    shown: dict[int, Array] = {}
    last = -np.inf
    for index, time in enumerate(run.times.tolist()):
        if not shapes or time < last + PERIOD - 1e-9:
            continue
        last = time
        scene.put(index)
        moved = []
        for number, shape in enumerate(shapes):
            position = data.geom_xpos[shape.geom]
            axes = data.geom_xmat[shape.geom].reshape(3, 3)
            now = np.column_stack([position, axes])
            if number not in shown or not np.allclose(
                shown[number], now, atol=1e-6
            ):
                shown[number] = now
                moved.append(
                    PlacedShape(
                        number, shape, position.copy(), quaternion_of(axes)
                    )
                )
        if moved:
            yield time, moved


def _shapes_of(model: mujoco.MjModel, run: Run) -> Iterator[RoomShape]:
    for geom in range(model.ngeom):
        kind = int(model.geom_type[geom])
        root = int(model.body_rootid[model.geom_bodyid[geom]])
        owner = model.body(root).name.split("/")[0]
        planes = (_GEOMS.mjGEOM_PLANE, _GEOMS.mjGEOM_HFIELD)
        if kind in planes or owner in run.robots:
            continue
        if model.geom_group[geom] > MAX_VISIBLE_GROUP:
            continue
        material = model.geom_matid[geom]
        rgba = (
            model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
        )
        if rgba[3] <= 0.0:
            continue
        name, size = _box_or_round(model, geom)
        red, green, blue, _ = rgba.tolist()
        player = owner if owner in run.players else "room"
        yield RoomShape(geom, name, size, (red, green, blue, 1.0), player)


def _box_or_round(
    model: mujoco.MjModel, geom: int
) -> tuple[str, tuple[float, float, float]]:
    """Return kind and full lengths of a geom as a marker has them."""
    kind = int(model.geom_type[geom])
    a, b, c = model.geom_size[geom].tolist()
    if kind == _GEOMS.mjGEOM_SPHERE:
        return "SPHERE", (2.0 * a, 2.0 * a, 2.0 * a)
    if kind == _GEOMS.mjGEOM_ELLIPSOID:
        return "SPHERE", (2.0 * a, 2.0 * b, 2.0 * c)
    if kind == _GEOMS.mjGEOM_CYLINDER:
        return "CYLINDER", (2.0 * a, 2.0 * a, 2.0 * b)
    if kind == _GEOMS.mjGEOM_CAPSULE:
        return "CYLINDER", (2.0 * a, 2.0 * a, 2.0 * (a + b))
    if kind != _GEOMS.mjGEOM_BOX:
        a, b, c = model.geom_aabb[geom, 3:].tolist()
    return "CUBE", (2.0 * a, 2.0 * b, 2.0 * c)


def room_markers(
    run: Run, factory: MessageFactory
) -> Iterator[tuple[float, Any]]:
    """Yield times, in [s], with marker arrays of the shapes that moved.

    Args:
        run: The run.
        factory: Maker of messages.
    """
    for time, moved in shapes_over_time(run):
        header = factory.header(time, "map")
        yield (
            time,
            factory.markers(
                [
                    factory.marker(
                        header,
                        placed.shape.owner,
                        placed.number,
                        placed.shape.kind,
                        factory.pose(
                            placed.position.tolist(),
                            factory.rotation(placed.quaternion.tolist()),
                        ),
                        placed.shape.size,
                        placed.shape.colour,
                    )
                    for placed in moved
                ]
            ),
        )
