"""Transforms of a recorded robot: joints, torso and soles at all samples."""

from typing import NamedTuple

import mujoco
import numpy as np

from ...core.poses import Array
from ...robots.urdf_elements import UrdfJoint
from .recording import RobotModel

LANDED = 0.02  # after its landing time a foot is on the floor, in [s]


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


def sole_poses(
    model: RobotModel, qpos: Array
) -> dict[int, tuple[Array, Array]]:
    """Return positions and quaternions of the soles in the world.

    Args:
        model: The robot.
        qpos: Free joint and joint positions. Shape (n, 7 + joints).

    Returns:
        Positions (n, 3) and quaternions (n, 4) by side: 1 left, -1 right.
    """
    moved = {p.joint.name: p for p in joint_poses(model, qpos)}
    above = {joint.child: joint for joint in model.tree.joints}
    free = qpos[:, :7].astype(np.float64)
    found = {}
    for side, link in ((1, "l_sole"), (-1, "r_sole")):
        chain: list[UrdfJoint] = []
        while link in above:
            chain.append(above[link])
            link = above[link].parent
        position, rotation = free[:, :3], free[:, 3:]
        for joint in reversed(chain):
            if joint.name in moved:
                step, turn = moved[joint.name][1:]
            else:
                step = np.tile(joint.position, (len(free), 1))
                turn = np.tile(quaternion_of(joint.axes), (len(free), 1))
            position = position + rotate(rotation, step)
            rotation = multiply(rotation, turn)
        found[side] = position, rotation
    return found


def landed_footsteps(
    model: RobotModel, times: Array, qpos: Array, landings: Array
) -> Array:
    """Return where feet stood after the planned landings.

    Args:
        model: The robot.
        times: Times of the samples, in [s]. Shape (n,).
        qpos: Free joint and joint positions. Shape (n, 7 + joints).
        landings: Planned landings, rows as in ``Trajectory``. Shape (m, 5).

    Returns:
        Rows (time, side, x, y, heading) of the landings before the end of
        the run: poses of the soles in the world. Shape (k, 5).
    """
    soles = sole_poses(model, qpos)
    rows = []
    for time, side, *_ in landings.tolist():
        index = int(np.searchsorted(times, time + LANDED))
        if index >= len(times):
            continue
        positions, rotations = soles[int(side)]
        w, x, y, z = rotations[index].tolist()
        heading = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        rows.append((time, side, *positions[index, :2], heading))
    return np.array(rows, dtype=np.float64).reshape(-1, 5)
