"""Visible geoms of a model, in the form in which all pages draw them."""

from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from ..sim.room_furnishing import is_room_wall

MAX_VISIBLE_GROUP = 2  # geoms of higher groups are collision shapes
WALL_HEIGHT = 1.5  # of a fixed box from which on it counts as a wall, in [m]
LABEL_GAP = 0.04  # between a player's highest point and its label, in [m]
MAX_TRIANGLES = 800  # of one mesh on a page
MIN_CELLS, MAX_CELLS = 2, 64  # along the longest side of a mesh
FOOTPRINT = 0.003  # height of a wall's outline over the floor, in [m]
_TYPES = mujoco.mjtGeom
KINDS = {
    int(_TYPES.mjGEOM_SPHERE): "sphere",
    int(_TYPES.mjGEOM_ELLIPSOID): "ellipsoid",
    int(_TYPES.mjGEOM_CAPSULE): "capsule",
    int(_TYPES.mjGEOM_CYLINDER): "cylinder",
    int(_TYPES.mjGEOM_BOX): "box",
}


class TriangleMesh(NamedTuple):
    """Triangle mesh."""

    vertices: Array  # in the frame of its geom, in [m]. Shape (vertices, 3)
    faces: NDArray[np.int64]  # three vertices each. Shape (faces, 3)


class VisualGeom(NamedTuple):
    """Visible shape that is fixed to one body.

    Attributes:
        body: Number of the body; 0 is the world.
        kind: One of ``KINDS``, or "mesh"; other types become their bounding
            "box".
        size: Half sizes along its axes, in [m], of a box, a mesh or an
            ellipsoid; radius of a sphere; radius and half length along z of
            a capsule or cylinder. Shape (3,).
        position: In the body, in [m]. Shape (3,).
        quaternion: (w, x, y, z) in the body. Shape (4,).
        colour: Red, green, blue, 0 to 255.
        mesh: Of a geom of kind "mesh".
        casts_shadow: Whether it casts a shadow. A wall of a room casts none,
            because only its inner face is drawn.
    """

    body: int
    kind: str
    size: Array
    position: Array
    quaternion: Array
    colour: tuple[int, int, int]
    mesh: TriangleMesh | None = None
    casts_shadow: bool = True

    @property
    def is_wall(self) -> bool:
        """Whether it would hide the players from an outside camera."""
        high = self.kind == "box" and 2.0 * float(self.size[2]) >= WALL_HEIGHT
        return self.body == 0 and high

    def to_json(self) -> dict[str, Any]:
        """Return plain values for a page, rounded to 0.1 mm."""
        red, green, blue = self.colour
        values: dict[str, Any] = {
            "body": self.body,
            "kind": self.kind,
            "size": np.round(self.size, 4).tolist(),
            "position": np.round(self.position, 4).tolist(),
            "quaternion": np.round(self.quaternion, 5).tolist(),
            "colour": f"#{red:02x}{green:02x}{blue:02x}",
            "wall": self.is_wall,
            "casts_shadow": self.casts_shadow,
        }
        if self.mesh is not None:
            values["vertices"] = np.round(self.mesh.vertices, 4).tolist()
            values["faces"] = self.mesh.faces.tolist()
        return values


def visual_geoms_of(model: mujoco.MjModel) -> list[VisualGeom]:
    """Return all visible geoms but the floor, which each page draws itself."""
    geoms = []
    for geom in range(model.ngeom):
        kind = int(model.geom_type[geom])
        if model.geom_group[geom] > MAX_VISIBLE_GROUP:
            continue
        if kind in (_TYPES.mjGEOM_PLANE, _TYPES.mjGEOM_HFIELD):
            continue
        size, position = model.geom_size[geom], model.geom_pos[geom]
        quaternion = model.geom_quat[geom]
        name, mesh = KINDS.get(kind, "box"), None
        if is_room_wall(model, geom):
            name, mesh = "mesh", inside_of_wall(model, geom)
        elif kind == _TYPES.mjGEOM_MESH:
            name, mesh = "mesh", _mesh_of(model, geom)
        elif kind not in KINDS:
            center, size = model.geom_aabb[geom].reshape(2, 3)
            offset = np.zeros(3)
            mujoco.mju_rotVecQuat(offset, center, quaternion)
            position = position + offset
        geoms.append(
            VisualGeom(
                int(model.geom_bodyid[geom]),
                name,
                np.array(size, dtype=np.float64),
                np.array(position, dtype=np.float64),
                np.array(quaternion, dtype=np.float64),
                colour_of(model, geom),
                mesh,
                not is_room_wall(model, geom),
            )
        )
    return geoms


def inside_of_wall(model: mujoco.MjModel, geom: int) -> TriangleMesh:
    """Return the inner face of a room's wall, and its footprint.

    Pages draw only the front of a face: from outside, the nearest wall hides
    nothing then, and its footprint shows where it stands. The room is
    centered at the world's origin.
    """
    half: Array = np.array(model.geom_size[geom])
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
    body = int(model.geom_bodyid[geom])
    position = rotation.reshape(3, 3).T @ model.body_pos[body]
    thin = int(np.argmin(half[:2]))
    long, inward = 1 - thin, -np.sign(position[thin])
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    face, footprint = np.zeros((4, 3)), np.zeros((4, 3))
    face[:, thin] = inward * half[thin]
    face[:, [long, 2]] = signs * half[[long, 2]]
    if inward * (1.0 if thin == 0 else -1.0) < 0.0:
        face = face[::-1]
    footprint[:, :2] = signs * half[:2]
    footprint[:, 2] = FOOTPRINT - half[2]
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    vertices = np.concatenate([face, footprint])
    return TriangleMesh(vertices, np.concatenate([triangles, triangles + 4]))


def colour_of(model: mujoco.MjModel, geom: int) -> tuple[int, int, int]:
    """Return the colour of a geom: red, green, blue, 0 to 255."""
    rgba = np.clip(rgba_of(model, geom), 0.0, 1.0)
    red, green, blue = (rgba[:3] * 255).astype(int)
    return int(red), int(green), int(blue)


def rgba_of(model: mujoco.MjModel, geom: int) -> Array:
    """Return the colour of a geom, or of its material, 0 to 1. Shape (4,)."""
    material = model.geom_matid[geom]
    rgba: Array = (
        model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    )
    return rgba


def label_over(
    model: mujoco.MjModel, data: mujoco.MjData, player: str
) -> tuple[int, float]:
    """Return a player's first body, and its label's height over it, in [m]."""
    bodies = [
        body
        for body in range(model.nbody)
        if model.body(body).name.startswith(f"{player}/")
    ]
    own = np.isin(model.geom_bodyid, bodies)
    own &= model.geom_group <= MAX_VISIBLE_GROUP
    tops = data.geom_xpos[own, 2] + model.geom_rbound[own]
    return bodies[0], float(tops.max() - data.xpos[bodies[0], 2]) + LABEL_GAP


def _mesh_of(model: mujoco.MjModel, geom: int) -> TriangleMesh:
    """Return the mesh of a mesh geom, simplified.

    Published models have meshes of some hundred thousand triangles. All
    vertices in one cell of a grid become their mean; the finest grid is
    taken whose mesh is small enough.
    """
    number = int(model.geom_dataid[geom])
    first, count = model.mesh_vertadr[number], model.mesh_vertnum[number]
    vertices = model.mesh_vert[first : first + count].astype(np.float64)
    first, count = model.mesh_faceadr[number], model.mesh_facenum[number]
    faces = model.mesh_face[first : first + count].astype(np.int64)
    return simplify(TriangleMesh(vertices, faces))


def simplify(mesh: TriangleMesh) -> TriangleMesh:
    """Reduce a mesh by vertex clustering, if it is too large."""
    cells, reduced = MAX_CELLS, mesh
    low = mesh.vertices.min(axis=0)
    side = max(float((mesh.vertices.max(axis=0) - low).max()), 1e-9)
    while len(reduced.faces) > MAX_TRIANGLES and cells >= MIN_CELLS:
        at = np.floor((mesh.vertices - low) * (cells / side))
        _, cell, counts = np.unique(
            at, axis=0, return_inverse=True, return_counts=True
        )
        means = np.zeros((len(counts), 3))
        np.add.at(means, cell, mesh.vertices)
        faces = cell[mesh.faces]
        a, b, c = faces.T
        faces = faces[(a != b) & (b != c) & (c != a)]
        _, kept = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
        reduced = TriangleMesh(means / counts[:, None], faces[np.sort(kept)])
        cells = int(cells / 1.3)
    return reduced
