"""A torso whose axes are not forward, left and up gets such axes."""

import mujoco
import numpy as np

from ..core.poses import Array

AHEAD = (1.0, 0.0, 0.0, 0.0)


def face(spec: mujoco.MjSpec, torso: str, turn: tuple[float, ...]) -> None:
    """Give a torso axes forward, left and up, and leave all else in place.

    Args:
        spec: The model; it is changed.
        torso: Its root, with nothing but a free joint.
        turn: Quaternion (w, x, y, z) of the published torso in these axes.
    """
    if tuple(turn) == AHEAD:
        return
    root = spec.body(torso)
    frame = root.add_frame(quat=turn)
    hanging = (root.bodies, root.geoms, root.sites, root.cameras, root.lights)
    for thing in [each for kind in hanging for each in kind]:
        top = thing
        while top.frame is not None and top.frame is not frame:
            top = top.frame
        if top is thing or top.frame is None:
            top.set_frame(frame)
    if root.explicitinertial:
        _turn_inertia(root, np.array(turn))


def _turn_inertia(root: mujoco.MjsBody, turn: Array) -> None:
    """See the mass of a body in other axes."""
    root.ipos[:] = turned(turn, np.array(root.ipos))
    if np.isnan(np.array(root.fullinertia)).any():
        whole = np.zeros(4)
        mujoco.mju_mulQuat(whole, turn, np.array(root.iquat))
        root.iquat[:] = whole
        return
    axes = matrix_of(turn)
    xx, yy, zz, xy, xz, yz = np.array(root.fullinertia).tolist()
    full = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    seen = axes @ full @ axes.T
    root.fullinertia[:] = seen[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def matrix_of(turn: Array) -> Array:
    """Matrix of a quaternion. Shape (3, 3)."""
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, turn / np.linalg.norm(turn))
    return axes.reshape(3, 3)


def turned(turn: Array, vector: Array) -> Array:
    """A vector in other axes. Shape (3,)."""
    seen: Array = matrix_of(turn) @ vector
    return seen
