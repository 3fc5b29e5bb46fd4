"""Rotation of a torso frame to axes forward, left and up."""

import mujoco
import numpy as np

from ..core.poses import Array
from ..core.rotations import rotation_of

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def rotate_torso_frame(
    spec: mujoco.MjSpec, torso: str, quaternion: tuple[float, ...]
) -> None:
    """Rotate the frame of a torso; its body and links do not move.

    The quaternion is the orientation of the published frame in the new one.
    """
    if tuple(quaternion) == IDENTITY:
        return
    root = spec.body(torso)
    frame = root.add_frame(quat=quaternion)
    children = (root.bodies, root.geoms, root.sites, root.cameras, root.lights)
    for element in [each for kind in children for each in kind]:
        top = element
        while top.frame is not None and top.frame is not frame:
            top = top.frame
        if top is element or top.frame is None:
            top.set_frame(frame)
    if root.explicitinertial:
        _rotate_inertia(root, np.array(quaternion))


def _rotate_inertia(root: mujoco.MjsBody, quaternion: Array) -> None:
    """Express CoM and inertia of a body in a rotated frame."""
    root.ipos[:] = rotation_of(quaternion) @ np.array(root.ipos)
    if np.isnan(np.array(root.fullinertia)).any():
        product = np.zeros(4)
        mujoco.mju_mulQuat(product, quaternion, np.array(root.iquat))
        root.iquat[:] = product
        return
    axes = rotation_of(quaternion)
    xx, yy, zz, xy, xz, yz = np.array(root.fullinertia).tolist()
    full = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    rotated = axes @ full @ axes.T
    root.fullinertia[:] = rotated[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
