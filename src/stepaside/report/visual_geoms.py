"""What is seen of a model: one list of parts for every page."""

from itertools import product
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..core.poses import Array
from ..sim.obstacle_geoms import is_room_wall
from .mesh_simplification import TriangleMesh, shell_of

VISIBLE = 2  # last geom group that is seen
TALL = 1.5  # height from which on what stands is a wall, in [m]
FOOTPRINT = 0.003  # height of a wall's outline over the floor, in [m]
_TYPES = mujoco.mjtGeom
KINDS = {
    int(_TYPES.mjGEOM_SPHERE): "sphere",
    int(_TYPES.mjGEOM_ELLIPSOID): "ellipsoid",
    int(_TYPES.mjGEOM_CAPSULE): "capsule",
    int(_TYPES.mjGEOM_CYLINDER): "cylinder",
    int(_TYPES.mjGEOM_BOX): "box",
}


class VisualGeom(NamedTuple):
    """A thing of simple shape, at rest in one body.

    Attributes:
        body: Number of the body; 0 is the world.
        kind: One of ``KINDS``, "mesh", or "box" round what else there is.
        size: Half sizes along its axes, in [m]: three of a box, of a mesh
            and of an ellipsoid; radius of a sphere; radius and half length
            along z of the others. Shape (3,).
        place: In the body, in [m]. Shape (3,).
        turn: Quaternion (w, x, y, z) in the body. Shape (4,).
        colour: Red, green, blue, 0 to 255.
        shell: Surface of a mesh, around its place; None of others.
        shades: Whether it casts a shadow; a wall of which only the inside
            is drawn does not.
    """

    body: int
    kind: str
    size: Array
    place: Array
    turn: Array
    colour: tuple[int, int, int]
    shell: TriangleMesh | None = None
    shades: bool = True

    @property
    def corners(self) -> Array:
        """Corners of a box around it, in its body, in [m]. Shape (8, 3)."""
        a, b, c = self.size.tolist()
        if self.kind == "sphere":
            b = c = a
        elif self.kind in ("capsule", "cylinder"):
            a, b, c = a, a, b + (a if self.kind == "capsule" else 0.0)
        signs = np.array(list(product((-1.0, 1.0), repeat=3)))
        frame = np.zeros(9)
        mujoco.mju_quat2Mat(frame, self.turn)
        around = signs * [a, b, c]
        corners: Array = around @ frame.reshape(3, 3).T + self.place
        return corners

    @property
    def is_wall(self) -> bool:
        """Whether it stands in the way of who looks from outside."""
        high = self.kind == "box" and 2.0 * float(self.size[2]) >= TALL
        return self.body == 0 and high

    def to_json(self) -> dict[str, Any]:
        """The same for a page, to a tenth of a millimetre."""
        red, green, blue = self.colour
        told: dict[str, Any] = {
            "body": self.body,
            "kind": self.kind,
            "size": np.round(self.size, 4).tolist(),
            "place": np.round(self.place, 4).tolist(),
            "turn": np.round(self.turn, 5).tolist(),
            "colour": f"#{red:02x}{green:02x}{blue:02x}",
            "wall": self.is_wall,
            "shades": self.shades,
        }
        if self.shell is not None:
            told["corners"] = np.round(self.shell.corners, 4).tolist()
            told["faces"] = self.shell.faces.tolist()
        return told


def parts_of(model: mujoco.MjModel) -> list[VisualGeom]:
    """Parts of all that is seen, but the floor, which every page lays."""
    parts = []
    for geom in range(model.ngeom):
        kind = int(model.geom_type[geom])
        if model.geom_group[geom] > VISIBLE or kind == _TYPES.mjGEOM_PLANE:
            continue
        if kind == _TYPES.mjGEOM_HFIELD:
            continue
        size, place = model.geom_size[geom], model.geom_pos[geom]
        turn = model.geom_quat[geom]
        name, shell = KINDS.get(kind, "box"), None
        if is_room_wall(model, geom):
            name, shell = "mesh", inside_of_wall(model, geom)
        elif kind == _TYPES.mjGEOM_MESH:
            name, shell = "mesh", shell_of(model, geom)
        elif kind not in KINDS:
            middle, size = model.geom_aabb[geom].reshape(2, 3)
            away = np.zeros(3)
            mujoco.mju_rotVecQuat(away, middle, turn)
            place = place + away
        parts.append(
            VisualGeom(
                int(model.geom_bodyid[geom]),
                name,
                np.array(size, dtype=np.float64),
                np.array(place, dtype=np.float64),
                np.array(turn, dtype=np.float64),
                colour_of(model, geom),
                shell,
                not is_room_wall(model, geom),
            )
        )
    return parts


def inside_of_wall(model: mujoco.MjModel, geom: int) -> TriangleMesh:
    """Return the face of a wall towards its room, and its footprint.

    Pages draw the front of a face alone: from outside, the nearest wall hides
    nothing then, and its footprint shows where it stands.

    Args:
        model: Of the room, in the middle of which is the world's origin.
        geom: Number of a box.

    Returns:
        Two rectangles in the frame of the geom; each is seen from the side
        on which its corners turn left.
    """
    half: Array = np.array(model.geom_size[geom])
    frame = np.zeros(9)
    mujoco.mju_quat2Mat(frame, model.geom_quat[geom])
    body = int(model.geom_bodyid[geom])
    place = frame.reshape(3, 3).T @ model.body_pos[body]
    thin = int(np.argmin(half[:2]))
    long, inward = 1 - thin, -np.sign(place[thin])
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    face, floor = np.zeros((4, 3)), np.zeros((4, 3))
    face[:, thin] = inward * half[thin]
    face[:, [long, 2]] = signs * half[[long, 2]]
    if inward * (1.0 if thin == 0 else -1.0) < 0.0:
        face = face[::-1]
    floor[:, :2] = signs * half[:2]
    floor[:, 2] = FOOTPRINT - half[2]
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    corners = np.concatenate([face, floor])
    return TriangleMesh(corners, np.concatenate([triangles, triangles + 4]))


def colour_of(model: mujoco.MjModel, geom: int) -> tuple[int, int, int]:
    """Colour of one geom, 0 to 255."""
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    red, green, blue = (np.clip(rgba[:3], 0.0, 1.0) * 255).astype(int)
    return int(red), int(green), int(blue)
