"""Visible bodies of a model in the scene of a page."""

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np
import trimesh
import viser

from ...core.poses import Array
from ..visual_geoms import VisualGeom, label_over, visual_geoms_of

SECTIONS = 20  # of a round shape


def shape_of(part: VisualGeom) -> trimesh.Trimesh:
    """Return the mesh of a visible geom in the frame of its body."""
    mesh: trimesh.Trimesh
    a, b, _ = part.size
    if part.mesh is not None:
        mesh = trimesh.Trimesh(*part.mesh, process=False)
    elif part.kind == "sphere":
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=a)
    elif part.kind == "ellipsoid":
        mesh = trimesh.creation.icosphere(subdivisions=2)
        mesh.vertices = mesh.vertices * part.size
    elif part.kind == "capsule":
        mesh = trimesh.creation.capsule(2 * b, a, [SECTIONS, SECTIONS])
    elif part.kind == "cylinder":
        mesh = trimesh.creation.cylinder(a, 2 * b, SECTIONS)
    else:
        mesh = trimesh.creation.box(2 * part.size)
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, part.quaternion)
    transform = np.eye(4)
    transform[:3, :3] = rotation.reshape(3, 3)
    transform[:3, 3] = part.position
    mesh.apply_transform(transform)
    return mesh


class SceneBodies:
    """Bodies of one model; each is a frame with one mesh per colour."""

    def __init__(
        self,
        scene: viser.SceneApi,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        players: Iterable[str],
    ) -> None:
        """Add all visible bodies but walls, and a label above each player.

        Names of bodies begin with their player's.
        """
        looks = defaultdict[
            int, defaultdict[tuple[Any, ...], list[trimesh.Trimesh]]
        ](lambda: defaultdict(list))
        for geom in visual_geoms_of(model):
            if not geom.is_wall:  # it would hide the players from outside
                look = geom.colour, geom.casts_shadow
                looks[geom.body][look].append(shape_of(geom))
        self._frames: dict[int, viser.FrameHandle] = {}
        self._labels = []
        for body, colours in looks.items():
            name = f"/bodies/{body}"
            self._frames[body] = scene.add_frame(name, show_axes=False)
            for number, ((colour, casts_shadow), meshes) in enumerate(
                colours.items()
            ):
                joined: Any = trimesh.util.concatenate(meshes)
                scene.add_mesh_simple(
                    f"{name}/{number}",
                    joined.vertices,
                    joined.faces,
                    color=colour,
                    cast_shadow=casts_shadow,
                    receive_shadow=False,
                )
        for player in players:
            body, height = label_over(model, data, player)
            label = scene.add_label(
                f"/names/{player}",
                player,
                anchor="bottom-center",
                depth_test=False,
            )
            self._labels.append((label, body, np.array([0.0, 0.0, height])))

    def remove(self) -> None:
        """Remove all bodies and labels from the scene."""
        for handle in (
            *self._frames.values(),
            *(label for label, *_ in self._labels),
        ):
            handle.remove()

    def move(self, positions: Array, quaternions: Array) -> None:
        """Move all bodies and labels: positions in [m], quaternions wxyz."""
        for body, frame in self._frames.items():
            frame.position = positions[body]
            frame.wxyz = quaternions[body]
        for label, body, above in self._labels:
            label.position = positions[body] + above
