"""Links and joints of a robot as URDF has them, from its MuJoCo model.

Joint angles mean the same in both. Transforms of a recording follow from the
same tree.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from ..core.rotations import rotation_of
from .description import RobotDescription
from .head import depth_camera_name, load_head

BASE = "base_link"
SOLES = ("l_sole", "r_sole")  # as in REP 120
IMU = "imu_link"
OPTICAL = "_optical_frame"  # z forward, x right, as in REP 103
CAMERA_AXES = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
_JOINTS = mujoco.mjtJoint


class UrdfLink(NamedTuple):
    """Link of a robot."""

    name: str
    # index of its body in the model; None for a frame without mass, -1 for a
    # link between two hinges of one body
    body: int | None
    # origin of the link in the body [m]: joint anchors of MuJoCo need not be
    # at the origin of a body, those of URDF are, (3,)
    anchor: Array


class UrdfJoint(NamedTuple):
    """Joint between two links."""

    name: str
    kind: str  # "fixed", "revolute", "continuous" or "prismatic"
    parent: str  # name of the parent link
    child: str  # name of the child link
    position: Array  # position of the child in the parent at angle 0 [m], (3,)
    # axes of the child in the parent at angle 0, as columns, (3, 3)
    axes: Array
    # index of the joint in the model; None if it is fixed
    number: int | None = None
    axis: Array = np.array([0.0, 0.0, 1.0])  # axis in the child, (3,)


class UrdfTree(NamedTuple):
    """Links and joints of a robot, from the root to the tips."""

    links: tuple[UrdfLink, ...]  # links; the first is the root
    # joints; each has a link as child that no other has
    joints: tuple[UrdfJoint, ...]


def urdf_tree(
    description: RobotDescription, model: mujoco.MjModel
) -> UrdfTree:
    """Return links and joints of a robot, as they are in its URDF.

    The root is ``base_link``, at the origin of the torso. The soles are
    ``l_sole`` and ``r_sole``; cameras of a described head have a frame
    each, with an optical frame.
    """
    data = mujoco.MjData(model)
    data.qpos[:] = 0.0
    mujoco.mj_kinematics(model, data)
    none, torso = np.zeros(3), model.body(description.torso).id
    links = [
        UrdfLink(BASE, None, none),
        UrdfLink(description.torso, torso, none),
    ]
    joints = [_fixed(BASE, description.torso, none, np.eye(3))]
    parents = {torso: links[1]}
    for body in range(torso + 1, model.nbody):
        parent = parents.get(int(model.body_parentid[body]))
        if parent is not None:
            added = _joints_of(model, data, body, parent)
            links += [UrdfLink(joint.child, -1, none) for joint in added[:-1]]
            count, anchor = int(model.body_jntnum[body]), none
            if count > 0:
                last = int(model.body_jntadr[body]) + count - 1
                anchor = model.jnt_pos[last].copy()
            parents[body] = UrdfLink(added[-1].child, body, anchor)
            links.append(parents[body])
            joints += added
    anchors = {link.name: link.anchor for link in links}
    for frame in _frames_of(description, model):
        position = frame.position - anchors[frame.parent]
        joints.append(frame._replace(position=position))
        links.append(UrdfLink(frame.child, None, none))
        if frame.child.endswith("camera"):
            optical = frame.child + OPTICAL
            joints.append(_fixed(frame.child, optical, none, CAMERA_AXES))
            links.append(UrdfLink(optical, None, none))
    return UrdfTree(tuple(links), tuple(joints))


def _frames_of(
    description: RobotDescription, model: mujoco.MjModel
) -> list[UrdfJoint]:
    """Return the frames of soles, IMU and cameras, placed in their bodies."""
    frames, feet = [], (description.left_foot, description.right_foot)
    for name, site in zip(SOLES, feet, strict=True):
        frames.append(_site_frame(model, name, model.site(site).id))
    gyro = model.sensor(description.sensors.gyro)
    frames.append(_site_frame(model, IMU, int(gyro.objid[0])))
    try:
        head = load_head(description)
    except ModelError:
        return frames  # it has no cameras
    mounts = {"camera": head.top}
    for i, lens in enumerate(head.depth):
        mounts[depth_camera_name(i)] = lens
    for name, mount in mounts.items():
        position, axes = mount.position_in_body, mount.axes_in_body
        frames.append(_fixed(head.body_of(mount), name, position, axes))
    return frames


def _site_frame(model: mujoco.MjModel, name: str, site: int) -> UrdfJoint:
    link = link_name(model, int(model.site_bodyid[site]))
    axes = rotation_of(model.site_quat[site])
    return _fixed(link, name, model.site_pos[site].copy(), axes)


def _joints_of(
    model: mujoco.MjModel, data: mujoco.MjData, body: int, parent: UrdfLink
) -> list[UrdfJoint]:
    """Return the joints of a body; several hinges get links between them."""
    before = data.xmat[parent.body].reshape(3, 3)
    place = data.xpos[parent.body] + before @ parent.anchor
    axes, own = data.xmat[body].reshape(3, 3), link_name(model, body)
    first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    if count == 0:
        position = before.T @ (data.xpos[body] - place)
        return [_fixed(parent.name, own, position, before.T @ axes)]
    joints: list[UrdfJoint] = []
    link = parent.name
    for index in range(first, first + count):
        name, kind = model.joint(index).name, _kind_of(model, index)
        child = own if index == first + count - 1 else f"{name}_link"
        anchor, axis = data.xanchor[index], data.xaxis[index]
        if kind == "prismatic":  # the anchor is that before it slides
            anchor = anchor - model.qpos0[model.jnt_qposadr[index]] * axis
        position, turned = before.T @ (anchor - place), before.T @ axes
        joints.append(
            UrdfJoint(
                *(name, kind, link, child, position, turned, index),
                axes.T @ axis,
            )
        )
        link, place, before = child, anchor, axes
    return joints


def _kind_of(model: mujoco.MjModel, joint: int) -> str:
    """Return the type of a joint in URDF."""
    kind = int(model.jnt_type[joint])
    if kind == _JOINTS.mjJNT_SLIDE:
        return "prismatic"
    if kind == _JOINTS.mjJNT_HINGE:
        return "revolute" if model.jnt_limited[joint] else "continuous"
    raise ModelError(
        f"joint {model.joint(joint).name!r} must be a hinge or a slide to be "
        "written as URDF, got a ball or free joint"
    )


def _fixed(parent: str, child: str, position: Array, axes: Array) -> UrdfJoint:
    return UrdfJoint(f"{child}_fixed", "fixed", parent, child, position, axes)


def link_name(model: mujoco.MjModel, body: int) -> str:
    """Return the name of the link of a body."""
    name: str = model.body(body).name
    return name or f"body_{body}"
