"""Transforms of a recorded robot: joints and torso at all samples."""

from typing import NamedTuple

import mujoco
import numpy as np

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
        quaternions = np.tile(quaternion_of(joint.axes), (len(values), 1))
        if joint.kind == "prismatic":
            positions = positions + np.outer(values, joint.axes @ joint.axis)
        else:
            half = 0.5 * values
            turned = np.column_stack(
                [np.cos(half), np.outer(np.sin(half), joint.axis)]
            )
            quaternions = multiply(quaternions, turned)
        found.append(JointPoses(joint, positions, quaternions))
    return found


def quaternion_of(axes: Array) -> Array:
    """Return the unit quaternion (w, x, y, z) of axes as columns."""
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(axes).reshape(9))
    return quaternion


def multiply(first: Array, second: Array) -> Array:
    """Multiply quaternions (w, x, y, z) row by row. Shapes (n, 4)."""
    a, b, c, d = first.T
    w, x, y, z = second.T
    return np.column_stack(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ]
    )


def rotate(quaternions: Array, vectors: Array) -> Array:
    """Rotate vectors by quaternions (w, x, y, z). Shapes (n, 4), (n, 3)."""
    w, axis = quaternions[:, :1], quaternions[:, 1:]
    across = 2.0 * np.cross(axis, vectors)
    rotated: Array = vectors + w * across + np.cross(axis, across)
    return rotated


def conjugate(quaternions: Array) -> Array:
    """Return the inverse of unit quaternions (w, x, y, z). Shape (n, 4)."""
    return quaternions * [1.0, -1.0, -1.0, -1.0]


def footprint_quaternions(poses: Array) -> Array:
    """Return rotations about the vertical of planar poses. Shape (n, 4).

    Args:
        poses: Rows (x, y, heading). Shape (n, 3).
    """
    half, none = 0.5 * poses[:, 2], np.zeros(len(poses))
    return np.column_stack([np.cos(half), none, none, np.sin(half)])


class BasePoses(NamedTuple):
    """Poses of ``base_link`` in ``base_footprint`` over time.

    Attributes:
        positions: Positions, in [m]. Shape (n, 3).
        quaternions: Rotations (w, x, y, z). Shape (n, 4).
    """

    positions: Array
    quaternions: Array


def base_poses(qpos: Array, footprints: Array) -> BasePoses:
    """Return the poses of a torso in its footprint.

    Args:
        qpos: Free joint and joint positions. Shape (n, 7 + joints).
        footprints: Poses of the reference point in the world: rows (x, y,
            heading). Shape (n, 3).
    """
    free = qpos[:, :7].astype(np.float64)
    upright = conjugate(footprint_quaternions(footprints))
    offset = free[:, :3].copy()
    offset[:, :2] -= footprints[:, :2]
    return BasePoses(rotate(upright, offset), multiply(upright, free[:, 3:]))
