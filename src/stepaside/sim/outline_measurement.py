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


def measure_outline(
    description: RobotDescription, gait: GaitSettings
) -> BodyOutline:
    """Measure the outline [m] of all that collides, in the stance of a gait.

    It is a polygon around trunk, head, arms and legs, in the frame of the
    body, and a rectangle around each foot in its frame. Round shapes count as
    the boxes around them.
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
    """Return the polygon around the boxes of geoms in a frame, (sides, 2)."""
    angles = np.arange(sides) * (2.0 * np.pi / sides)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    level = np.zeros((sides, 3))
    level[:, :2] = normals @ axes.T
    around = model.geom_aabb[geoms]  # centres and half sizes of boxes
    turned = level @ data.geom_xmat[geoms].reshape(-1, 3, 3)
    reach = np.einsum("gnk,gk->gn", turned, around[:, :3])
    reach += np.einsum("gnk,gk->gn", np.abs(turned), around[:, 3:])
    reach = (reach + data.geom_xpos[geoms] @ level.T).max(axis=0)
    reach -= level[:, :2] @ origin
    # Each corner is the intersection of two consecutive lines.
    after, farther = np.roll(normals, -1, axis=0), np.roll(reach, -1)
    lines = np.stack([normals, after], axis=1)
    corners: Array = np.linalg.solve(
        lines, np.stack([reach, farther], axis=1)[:, :, None]
    )[:, :, 0]
    return corners


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
            floor, unknown_is_free=known.unseen == "free"
        )
    outline = measure_outline(description, gait)
    return ClearanceSetup(surroundings, outline, known.margin)
