"""Obstacles, persons and templates of a run as a URDF with moving links."""

from collections.abc import Iterator
from typing import NamedTuple
from xml.etree import ElementTree

import mujoco
import numpy as np

from ...core.poses import Array
from ...games.run import Run
from ..scene import RunScene
from ..visual_geoms import MAX_VISIBLE_GROUP, rgba_of
from .recorded_transforms import quaternion_of

PERIOD = 0.1  # between poses of shapes that move, in [s]
_GEOMS = mujoco.mjtGeom


class RoomShape(NamedTuple):
    """Shape that does not belong to a robot.

    Attributes:
        geom: Index of the geom in the model of the scene.
        shape: Element of URDF: its name and its attributes, in [m].
        colour: Red, green, blue, opacity, 0 to 1.
    """

    geom: int
    shape: tuple[str, dict[str, str]]
    colour: tuple[float, float, float, float]


class PlacedShape(NamedTuple):
    """Shape with its pose in the world.

    Attributes:
        frame: Name of its link and frame.
        position: Position, in [m]. Shape (3,).
        quaternion: Rotation (w, x, y, z). Shape (4,).
    """

    frame: str
    position: Array
    quaternion: Array


class RoomModel:
    """Everything in the scene of a run that is no robot.

    Attributes:
        shapes: The shapes; each is a link of :attr:`urdf`.
    """

    def __init__(self, run: Run) -> None:
        """Find the shapes of a run."""
        self._run, self._scene = run, RunScene(run)
        self.shapes = tuple(_shapes_of(self._scene.model, run))

    @property
    def urdf(self) -> str:
        """URDF with a link for each shape, free in ``map``."""
        room = ElementTree.Element("robot", name="room")
        ElementTree.SubElement(room, "link", name="map")
        for number, shape in enumerate(self.shapes):
            frame = _frame(number)
            link = ElementTree.SubElement(room, "link", name=frame)
            visual = ElementTree.SubElement(link, "visual")
            geometry = ElementTree.SubElement(visual, "geometry")
            ElementTree.SubElement(geometry, shape.shape[0], shape.shape[1])
            material = ElementTree.SubElement(visual, "material", name=frame)
            rgba = " ".join(f"{part:.4g}" for part in shape.colour)
            ElementTree.SubElement(material, "color", rgba=rgba)
            joint = ElementTree.SubElement(
                room, "joint", name=f"{frame}/joint", type="floating"
            )
            ElementTree.SubElement(joint, "parent", link="map")
            ElementTree.SubElement(joint, "child", link=frame)
        return ElementTree.tostring(room, encoding="unicode")

    def moved(self) -> Iterator[tuple[int, list[PlacedShape]]]:
        """Yield samples with the shapes that moved since the last.

        Sample 0 has all shapes; nothing is yielded without shapes.
        """
        scene, data = self._scene, self._scene.data
        shown: dict[int, Array] = {}
        last = -np.inf
        for index, time in enumerate(self._run.times.tolist()):
            if not self.shapes or time < last + PERIOD - 1e-9:
                continue
            last = time
            scene.put(index)
            moved = []
            for number, shape in enumerate(self.shapes):
                position = data.geom_xpos[shape.geom]
                axes = data.geom_xmat[shape.geom].reshape(3, 3)
                now = np.column_stack([position, axes])
                if number not in shown or not np.allclose(
                    shown[number], now, atol=1e-6
                ):
                    shown[number] = now
                    moved.append(
                        PlacedShape(
                            _frame(number),
                            position.copy(),
                            quaternion_of(axes),
                        )
                    )
            if moved:
                yield index, moved


def _frame(number: int) -> str:
    return f"room/{number}"


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
        red, green, blue, opacity = rgba_of(model, geom).tolist()
        if opacity > 0.0:
            rgba = red, green, blue, 1.0
            yield RoomShape(geom, _urdf_shape(model, geom), rgba)


def _urdf_shape(
    model: mujoco.MjModel, geom: int
) -> tuple[str, dict[str, str]]:
    """Return the shape of a geom; an ellipsoid or a mesh is its box."""
    kind = int(model.geom_type[geom])
    a, b, c = model.geom_size[geom].tolist()
    if kind == _GEOMS.mjGEOM_SPHERE:
        return "sphere", {"radius": f"{a:.6g}"}
    if kind == _GEOMS.mjGEOM_CYLINDER:
        return "cylinder", {"radius": f"{a:.6g}", "length": f"{2 * b:.6g}"}
    if kind == _GEOMS.mjGEOM_CAPSULE:
        length = 2.0 * (a + b)
        return "cylinder", {"radius": f"{a:.6g}", "length": f"{length:.6g}"}
    if kind not in (_GEOMS.mjGEOM_BOX, _GEOMS.mjGEOM_ELLIPSOID):
        a, b, c = model.geom_aabb[geom, 3:].tolist()
    return "box", {"size": f"{2 * a:.6g} {2 * b:.6g} {2 * c:.6g}"}
