"""Transforms of a recorded robot: joints and torso at all samples."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.poses import Array
from ...robots.urdf_elements import UrdfJoint
from .recording import RobotModel


class JointPoses(NamedTuple):
    """Poses of the children of moving joints in their parents.

    Attributes:
        joint: The joint.
        positions: Positions, in [m]. Shape (n, 3).
        quaternions: Rotations (w, x, y, z). Shape (n, 4).
    """

    joint: UrdfJoint
    positions: Array
    quaternions: Array


def joint_poses(model: RobotModel, qpos: Array) -> list[JointPoses]:
    """Return the transforms of the moving joints of a robot.

    Args:
        model: The robot.
        qpos: Free joint and joint positions. Shape (n, 7 + joints).
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
        found.append(JointPoses(joint, positions, quaternions))
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
