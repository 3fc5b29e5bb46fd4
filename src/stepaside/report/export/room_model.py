"""Obstacles, persons and templates of a run as a URDF with moving links."""

from typing import Any
from xml.etree import ElementTree

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.poses import Array
from ...core.rotations import angles_of
from ...games.run import Run
from ..scene import RunScene
from ..visual_geoms import VisualGeom, visual_geoms_of

PERIOD = 0.1  # between poses of links that move, in [s]


class RoomModel:
    """Everything in the scene of a run that is no robot.

    Attributes:
        urdf: URDF with a link for each body, free in ``map``; empty if there
            is none.
        frames: Names of the links, which are their frames.
        moves: Whether each moves. Shape (links,).
        samples: Samples of the run at which poses are given. Shape (k,).
        positions: In the world, in [m]. Shape (k, links, 3).
        quaternions: (w, x, y, z). Shape (k, links, 4).
    """

    def __init__(self, run: Run) -> None:
        """Find the bodies of a run, and how they move."""
        scene = RunScene(run)
        model, data = scene.model, scene.data
        shapes: dict[int, list[VisualGeom]] = {}
        for geom in visual_geoms_of(model):
            root = model.body(int(model.body_rootid[geom.body])).name
            if root.split("/")[0] not in run.robots:
                shapes.setdefault(geom.body, []).append(geom)
        bodies = list(shapes)
        self.frames = [f"room/{body}" for body in bodies]
        gap = float(run.times[1] - run.times[0]) if len(run.times) > 1 else 1.0
        every = max(1, round(PERIOD / gap))
        self.samples = np.arange(0, len(run.times) if bodies else 1, every)
        self.positions = np.zeros((len(self.samples), len(bodies), 3))
        self.quaternions = np.zeros((len(self.samples), len(bodies), 4))
        for row, index in enumerate(self.samples.tolist() if bodies else ()):
            scene.put(index)
            self.positions[row] = data.xpos[bodies]
            self.quaternions[row] = data.xquat[bodies]
        both = np.concatenate([self.positions, self.quaternions], axis=2)
        self.moves = np.ptp(both, axis=0).max(axis=1, initial=0.0) > 1e-6
        self.urdf = ""
        if bodies:
            linked = zip(self.frames, shapes.values(), strict=True)
            self.urdf = _urdf_of(dict(linked))


def _urdf_of(shapes: dict[str, list[VisualGeom]]) -> str:
    """Return a URDF of links with their shapes."""
    add = ElementTree.SubElement
    room = ElementTree.Element("robot", name="room")
    add(room, "link", name="map")
    for frame, geoms in shapes.items():
        link = add(room, "link", name=frame)
        for number, geom in enumerate(geoms):
            visual = add(link, "visual")
            turn = Rotation.from_quat(geom.quaternion, scalar_first=True)
            rpy = _numbers(angles_of(turn.as_matrix()))
            add(visual, "origin", xyz=_numbers(geom.position), rpy=rpy)
            kind, sizes = _urdf_shape(geom)
            add(add(visual, "geometry"), kind, sizes)
            material = add(visual, "material", name=f"{frame}/{number}")
            rgba = (*(part / 255.0 for part in geom.colour), 1.0)
            add(material, "color", rgba=_numbers(rgba))
        joint = add(room, "joint", name=f"{frame}/joint", type="floating")
        add(joint, "parent", link="map")
        add(joint, "child", link=frame)
    return ElementTree.tostring(room, encoding="unicode")


def _numbers(values: Any) -> str:
    return " ".join(f"{value:.6g}" for value in values)


def _urdf_shape(geom: VisualGeom) -> tuple[str, dict[str, str]]:
    """Return the shape of a geom; an ellipsoid or a mesh is its box."""
    a, b, _ = geom.size.tolist()
    if geom.kind == "sphere":
        return "sphere", {"radius": f"{a:.6g}"}
    if geom.kind in ("capsule", "cylinder"):
        length = 2.0 * (a + b if geom.kind == "capsule" else b)
        return "cylinder", {"radius": f"{a:.6g}", "length": f"{length:.6g}"}
    box: Array = 2.0 * geom.size
    return "box", {"size": _numbers(box)}
