"""Transforms of a recorded robot: joints and torso at all samples."""

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.poses import Array
from ...robots.urdf_writer import UrdfJoint
from .recording import RobotModel


def joint_poses(
    model: RobotModel, qpos: Array
) -> list[tuple[UrdfJoint, Array, Array]]:
    """Return the transforms of the moving joints of a robot.

    Args:
        model: The robot.
        qpos: Free joint and joint positions. Shape (n, 7 + joints).

    Returns:
        Each joint with the positions of its child in its parent, in [m], of
        shape (n, 3), and the rotations (w, x, y, z), of shape (n, 4).
    """
    column = {name: 7 + i for i, name in enumerate(model.joints)}
    found = []
    for joint in model.tree.joints:
        if joint.number is None:
            continue
        values = qpos[:, column[joint.name]].astype(np.float64)
        positions = np.tile(joint.position, (len(values), 1))
        if joint.kind == "prismatic":
            positions = positions + np.outer(values, joint.axes @ joint.axis)
            values = np.zeros(len(values))
        turned = Rotation.from_rotvec(np.outer(values, joint.axis))
        turned = Rotation.from_matrix(joint.axes) * turned
        quaternions = turned.as_quat(scalar_first=True)
        found.append((joint, positions, quaternions))
    return found


def quaternion_of(axes: Array) -> Array:
    """Return the unit quaternion (w, x, y, z) of axes as columns."""
    found: Array = Rotation.from_matrix(axes).as_quat(scalar_first=True)
    return found


def base_poses(qpos: Array, footprints: Array) -> tuple[Array, Array]:
    """Return the poses of a torso, ``base_link``, in its footprint.

    Args:
        qpos: Free joint and joint positions. Shape (n, 7 + joints).
        footprints: Poses of the reference point in the world: rows (x, y,
            heading). Shape (n, 3).

    Returns:
        Positions, in [m], of shape (n, 3), and rotations (w, x, y, z), of
        shape (n, 4).
    """
    free = qpos[:, :7].astype(np.float64)
    level = Rotation.from_euler("z", -footprints[:, 2:])
    offset = free[:, :3].copy()
    offset[:, :2] -= footprints[:, :2]
    torso = level * Rotation.from_quat(free[:, 3:], scalar_first=True)
    return level.apply(offset), torso.as_quat(scalar_first=True)
