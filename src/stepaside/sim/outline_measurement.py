"""Outline of a robot, and what it knows of the room around it."""

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..arena import Room
from ..core.poses import Array, Pose
from ..locomotion.control_settings import MapSettings
from ..locomotion.guard import (
    ClearanceSetup,
    KnownRoom,
    MappedRoom,
)
from ..locomotion.locomotion import Surroundings
from ..locomotion.swept_outline import BodyOutline
from ..locomotion.zmp.reference_table import initial_stance
from ..planning import GaitSettings
from ..robots.description import RobotDescription
from ..robots.leg_kinematics import LegKinematics

if TYPE_CHECKING:
    from ..perception.floor_map import FloorMap

SIDES = 32  # of the polygon around the trunk
REACH_SIDES = 72  # of the polygon that finds the reach of a body


def measure_outline(
    description: RobotDescription, gait: GaitSettings
) -> BodyOutline:
    """Measure the outline [m] of all that collides, in the stance of a gait.

    It is a polygon around trunk, head, arms and legs, in the frame of the
    body, and a rectangle around each foot in its frame.
    """
    kinematics = LegKinematics(description, tick=1.0)
    kinematics.stand(initial_stance(gait))
    model = description.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = kinematics.posture
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    feet = (description.left_foot, description.right_foot)
    bodies = [int(model.site(foot).bodyid[0]) for foot in feet]
    solid = np.flatnonzero((model.geom_contype | model.geom_conaffinity) != 0)
    owners = model.geom_bodyid[solid]
    # The legs of a standing robot lie between trunk and soles.
    root = model.body(description.torso).id
    trunk = _outline_of(
        model,
        data,
        solid[~np.isin(owners, bodies)],
        data.subtree_com[root][:2],
        np.array([[1.0, 0.0], [0.0, 1.0]]),
        SIDES,
    )
    soles = []
    for foot, body in zip(feet, bodies, strict=True):
        site = data.site(foot)
        axes = site.xmat.reshape(3, 3)[:2, :2]
        own = solid[owners == body]
        soles.append(_outline_of(model, data, own, site.xpos[:2], axes, 4))
    return BodyOutline(trunk, *soles)


def _outline_of(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geoms: NDArray[np.int_],
    origin: Array,
    axes: Array,
    sides: int,
) -> Array:
    """Return the polygon around geoms in a frame, (sides, 2)."""
    angles = np.arange(sides) * (2.0 * np.pi / sides)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    level = np.zeros((sides, 3))
    level[:, :2] = normals @ axes.T
    reach = extents(model, data, geoms, level).max(axis=0)
    reach -= level[:, :2] @ origin
    # Each corner is the intersection of two consecutive lines.
    after, farther = np.roll(normals, -1, axis=0), np.roll(reach, -1)
    lines = np.stack([normals, after], axis=1)
    corners: Array = np.linalg.solve(
        lines, np.stack([reach, farther], axis=1)[:, :, None]
    )[:, :, 0]
    return corners


def extents(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geoms: NDArray[np.int_],
    directions: Array,
) -> Array:
    """Return how far geoms extend in directions of the world, in [m].

    From the origin. Directions have shape (n, 3), the result (geoms, n).
    """
    kinds = mujoco.mjtGeom
    found = []
    for geom in geoms.tolist():
        own = directions @ data.geom_xmat[geom].reshape(3, 3)
        kind, size = int(model.geom_type[geom]), model.geom_size[geom]
        along = np.abs(own)
        if kind == int(kinds.mjGEOM_SPHERE):
            reach = np.full(len(own), size[0])
        elif kind == int(kinds.mjGEOM_CAPSULE):
            reach = size[0] + size[1] * along[:, 2]
        elif kind == int(kinds.mjGEOM_CYLINDER):
            level = np.hypot(own[:, 0], own[:, 1])
            reach = size[0] * level + size[1] * along[:, 2]
        elif kind == int(kinds.mjGEOM_ELLIPSOID):
            reach = np.linalg.norm(own * size, axis=1)
        elif kind == int(kinds.mjGEOM_MESH):
            mesh = model.geom_dataid[geom]
            first = model.mesh_vertadr[mesh]
            last = first + model.mesh_vertnum[mesh]
            reach = (own @ model.mesh_vert[first:last].T).max(axis=1)
        else:  # the box around it
            centre, half = np.split(model.geom_aabb[geom], 2)
            reach = own @ centre + along @ half
        found.append(reach + directions @ data.geom_xpos[geom])
    return np.array(found)


def solid_geoms(model: mujoco.MjModel, root: int) -> NDArray[np.int_]:
    """Return the geoms that collide of a body and those that it carries."""
    solid = (model.geom_contype | model.geom_conaffinity) != 0
    own = model.body_rootid[model.geom_bodyid] == root
    return np.flatnonzero(solid & own)


def reach_of(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geoms: NDArray[np.int_],
    place: tuple[float, float],
) -> float:
    """Return the radius of the circle around a place with all geoms, [m].

    In a top view; at most one in a thousand too large.
    """
    angles = np.arange(REACH_SIDES) * (2.0 * np.pi / REACH_SIDES)
    level = np.zeros((REACH_SIDES, 3))
    level[:, 0], level[:, 1] = np.cos(angles), np.sin(angles)
    most = extents(model, data, geoms, level) - level[:, :2] @ place
    return float(most.max() / np.cos(np.pi / REACH_SIDES))


def clearance_in(
    room: Room,
    known: MapSettings,
    start: Pose,
    description: RobotDescription,
    gait: GaitSettings,
    floor: "FloorMap | None" = None,
) -> ClearanceSetup:
    """Return what a robot knows of a room, given or mapped on its floor."""
    surroundings: Surroundings = KnownRoom(room, start)
    if known.source == "seen":
        assert floor is not None
        surroundings = MappedRoom(
            floor, unknown_is_free=known.unknown == "free"
        )
    outline = measure_outline(description, gait)
    return ClearanceSetup(surroundings, outline, known.margin)
