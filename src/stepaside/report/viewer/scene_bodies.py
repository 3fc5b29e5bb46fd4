"""Visible bodies of a model on the page."""

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np
import trimesh
import viser
from numpy.typing import NDArray

from ...core.poses import Array
from ..body_heights import BodyHeights
from ..visual_geoms import VisualGeom, parts_of

RING = 20  # corners of a round shape
LABEL = 0.04  # of a name over the highest point of its player, in [m]


def shape_of(part: VisualGeom) -> trimesh.Trimesh:
    """Mesh of one part in the frame of its body."""
    mesh: trimesh.Trimesh
    a, b, _ = part.size
    if part.shell is not None:
        mesh = trimesh.Trimesh(*part.shell, process=False)
    elif part.kind == "sphere":
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=a)
    elif part.kind == "ellipsoid":
        mesh = trimesh.creation.icosphere(subdivisions=2)
        mesh.vertices = mesh.vertices * part.size
    elif part.kind == "capsule":
        mesh = trimesh.creation.capsule(2 * b, a, [RING, RING])
    elif part.kind == "cylinder":
        mesh = trimesh.creation.cylinder(a, 2 * b, RING)
    else:
        mesh = trimesh.creation.box(2 * part.size)
    place = np.eye(4)
    frame = np.zeros(9)
    mujoco.mju_quat2Mat(frame, part.turn)
    place[:3, :3] = frame.reshape(3, 3)
    place[:3, 3] = part.place
    mesh.apply_transform(place)
    return mesh


def joined(
    meshes: list[trimesh.Trimesh],
) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Corners and triangles of several meshes as one."""
    corners = np.concatenate([mesh.vertices for mesh in meshes])
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [
        mesh.faces + start
        for mesh, start in zip(meshes, starts[:-1], strict=True)
    ]
    return corners.astype(np.float32), np.concatenate(faces).astype(np.uint32)


class SceneBodies:
    """Bodies of one model; what moves is one frame for each body."""

    def __init__(self, scene: viser.SceneApi, model: mujoco.MjModel) -> None:
        """Put every part that is seen on the page, once."""
        looks = defaultdict[
            int, defaultdict[tuple[Any, ...], list[trimesh.Trimesh]]
        ](lambda: defaultdict(list))
        parts = parts_of(model)
        for part in parts:
            if not part.is_wall:  # it would hide all from who is outside
                look = part.colour, part.shades
                looks[part.body][look].append(shape_of(part))
        self._frames: dict[int, viser.FrameHandle] = {}
        self._meshes = defaultdict[int, list[viser.MeshHandle]](list)
        self._tops = BodyHeights(parts)
        self._names: dict[tuple[int, ...], viser.LabelHandle] = {}
        for body, colours in looks.items():
            name = f"/bodies/{body}"
            self._frames[body] = scene.add_frame(name, show_axes=False)
            for number, ((colour, shades), meshes) in enumerate(
                colours.items()
            ):
                corners, faces = joined(meshes)
                mesh = scene.add_mesh_simple(
                    f"{name}/{number}",
                    corners,
                    faces,
                    color=colour,
                    cast_shadow=shades,
                    receive_shadow=False,
                )
                self._meshes[body].append(mesh)
        self._scene = scene

    def name(self, model: mujoco.MjModel, players: Iterable[str]) -> None:
        """Write the name of each player over it, wherever it moves.

        Args:
            model: Of the bodies, which begin with the names of their players.
            players: Their names.
        """
        for player in players:
            own = tuple(self._own(model, player))
            self._names[own] = self._scene.add_label(
                f"/names/{player}",
                player,
                anchor="bottom-center",
                depth_test=False,
            )

    def _own(self, model: mujoco.MjModel, player: str) -> list[int]:
        """Bodies of a player."""
        return [
            body
            for body in self._frames
            if model.body(body).name.startswith(f"{player}/")
        ]

    def meshes_of(
        self, model: mujoco.MjModel, player: str
    ) -> list[viser.MeshHandle]:
        """What is seen of a player.

        Args:
            model: Of the bodies.
            player: Its name.
        """
        own = self._own(model, player)
        return [mesh for body in own for mesh in self._meshes[body]]

    def move(self, positions: Array, quaternions: Array) -> None:
        """Move all bodies.

        Args:
            positions: In the world, in [m]. Shape (bodies, 3).
            quaternions: (w, x, y, z). Shape (bodies, 4).
        """
        for body, frame in self._frames.items():
            frame.position = positions[body]
            frame.wxyz = quaternions[body]
        for own, label in self._names.items():
            x, y = positions[list(own), :2].mean(axis=0).tolist()
            top = self._tops.of(own, positions, quaternions)
            label.position = (x, y, top + LABEL)
