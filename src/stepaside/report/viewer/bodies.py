"""Visible bodies of a model on the page."""

from collections import defaultdict

import mujoco
import numpy as np
import trimesh
import viser
from numpy.typing import NDArray

from ...poses import Array

VISIBLE = 2  # last geom group that is seen
RING = 20  # corners of a round shape


def shape_of(model: mujoco.MjModel, geom: int) -> trimesh.Trimesh | None:
    """Mesh of one geom in the frame of its body; None if it has none."""
    mesh: trimesh.Trimesh
    kind, size = model.geom_type[geom], model.geom_size[geom]
    types = mujoco.mjtGeom
    if kind == types.mjGEOM_SPHERE:
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=size[0])
    elif kind == types.mjGEOM_ELLIPSOID:
        mesh = trimesh.creation.icosphere(subdivisions=2)
        mesh.vertices = mesh.vertices * size
    elif kind == types.mjGEOM_CAPSULE:
        mesh = trimesh.creation.capsule(2 * size[1], size[0], [RING, RING])
    elif kind == types.mjGEOM_CYLINDER:
        mesh = trimesh.creation.cylinder(size[0], 2 * size[1], RING)
    elif kind == types.mjGEOM_BOX:
        mesh = trimesh.creation.box(2 * size)
    else:
        return None
    place = np.eye(4)
    frame = np.zeros(9)
    mujoco.mju_quat2Mat(frame, model.geom_quat[geom])
    place[:3, :3] = frame.reshape(3, 3)
    place[:3, 3] = model.geom_pos[geom]
    mesh.apply_transform(place)
    return mesh


def colour_of(model: mujoco.MjModel, geom: int) -> tuple[int, int, int]:
    """Colour of one geom, 0 to 255."""
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    red, green, blue = (np.clip(rgba[:3], 0.0, 1.0) * 255).astype(int)
    return int(red), int(green), int(blue)


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


class Bodies:
    """Bodies of one model; what moves is one frame for each body."""

    def __init__(self, scene: viser.SceneApi, model: mujoco.MjModel) -> None:
        """Put every visible geom on the page, once."""
        parts: dict[int, dict[tuple[int, int, int], list[trimesh.Trimesh]]]
        parts = defaultdict(lambda: defaultdict(list))
        for geom in range(model.ngeom):
            if model.geom_group[geom] > VISIBLE:
                continue
            mesh = shape_of(model, geom)
            if mesh is not None:
                body = int(model.geom_bodyid[geom])
                parts[body][colour_of(model, geom)].append(mesh)
        self._frames: dict[int, viser.FrameHandle] = {}
        for body, colours in parts.items():
            name = f"/bodies/{body}"
            self._frames[body] = scene.add_frame(name, show_axes=False)
            for number, (colour, meshes) in enumerate(colours.items()):
                corners, faces = joined(meshes)
                scene.add_mesh_simple(
                    f"{name}/{number}",
                    corners,
                    faces,
                    color=colour,
                    receive_shadow=False,
                )

    def move(self, positions: Array, quaternions: Array) -> None:
        """Move all bodies.

        Args:
            positions: In the world, in [m]. Shape (bodies, 3).
            quaternions: (w, x, y, z). Shape (bodies, 4).
        """
        for body, frame in self._frames.items():
            frame.position = positions[body]
            frame.wxyz = quaternions[body]
