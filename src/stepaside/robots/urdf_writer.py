"""URDF of a robot, from the compiled MuJoCo model of its description.

The file needs no other file: shapes are primitives. A capsule becomes a
cylinder with two spheres, an ellipsoid a row of spheres, and any other shape,
such as a mesh, its bounding box. Joint angles mean the same as in the model.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple
from xml.etree import ElementTree

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.player_colours import Colour
from ..core.poses import Array
from ..core.rotations import angles_of, rotation_of
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


RANGE = ("lower", "upper")
UNLIMITED = 1e6  # effort of a motor without a limit, in [N m]
VISIBLE_GROUP = 2  # geoms of higher groups are not drawn
_GEOMS = mujoco.mjtGeom


def urdf_of(
    description: RobotDescription, colour: Colour | None = None
) -> str:
    """Return the URDF of a robot, as XML text; see :func:`urdf_tree`."""
    model = description.compile(colour)
    tree = urdf_tree(description, model)
    coupled = description.coupled_joints(model)
    name = "_".join(description.name.lower().split())
    robot = ElementTree.Element("robot", name=name)
    for link in tree.links:
        element = _add(robot, "link", name=link.name)
        if link.body == -1:  # simulators want an inertia between two hinges
            _add_inertia(element, 1e-6, np.full(3, 1e-9))
        elif link.body is not None:
            _add_body(element, model, link.body, link.anchor)
    for joint in tree.joints:
        element = _add(robot, "joint", name=joint.name, type=joint.kind)
        _add(element, "parent", link=joint.parent)
        _add(element, "child", link=joint.child)
        _add_origin(element, joint.position, joint.axes)
        if joint.number is not None:
            _add(element, "axis", xyz=joint.axis)
            limits = {}
            if model.jnt_limited[joint.number]:
                limits = dict(
                    zip(RANGE, model.jnt_range[joint.number], strict=True)
                )
            limits["effort"] = _effort(model, joint)
            speeds = description.speed_limits
            limits["velocity"] = speeds.get(joint.name, UNLIMITED)
            _add(element, "limit", **limits)
            dof = int(model.jnt_dofadr[joint.number])
            _add(
                element,
                "dynamics",
                damping=model.dof_damping[dof],
                friction=model.dof_frictionloss[dof],
            )
        if joint.name in coupled:
            _add(element, "mimic", joint=coupled[joint.name])
    ElementTree.indent(robot)
    header = f"<!-- {description.name}, from {description.path.name} -->\n"
    return header + ElementTree.tostring(robot, encoding="unicode") + "\n"


def _add(
    parent: ElementTree.Element, tag: str, **values: Any
) -> ElementTree.Element:
    """Add an element with texts, numbers and arrays of them."""
    texts = {}
    for name, value in values.items():
        if not isinstance(value, str):
            numbers = np.ravel(value).tolist()
            numbers = [0.0 if abs(x) < 1e-12 else x for x in numbers]
            value = " ".join(f"{x:.12g}" for x in numbers)
        texts[name] = value
    return ElementTree.SubElement(parent, tag, texts)


def _add_origin(
    parent: ElementTree.Element, position: Array, axes: Array
) -> None:
    """Add an origin with roll, pitch and yaw about fixed axes."""
    _add(parent, "origin", xyz=position, rpy=angles_of(axes))


def _add_inertia(
    link: ElementTree.Element,
    mass: float,
    moments: Array,
    pose: tuple[Array, Array] | None = None,
) -> None:
    inertial = _add(link, "inertial")
    if pose is not None:
        _add_origin(inertial, *pose)
    _add(inertial, "mass", value=mass)
    x, y, z = moments
    _add(inertial, "inertia", ixx=x, iyy=y, izz=z, ixy=0, ixz=0, iyz=0)


def _add_body(
    link: ElementTree.Element,
    model: mujoco.MjModel,
    body: int,
    anchor: Array,
) -> None:
    """Add inertia and shapes of a body to its link."""
    mass = float(model.body_mass[body])
    if mass > 0.0:
        axes = rotation_of(model.body_iquat[body])
        pose = model.body_ipos[body] - anchor, axes
        _add_inertia(link, mass, model.body_inertia[body], pose)
    first = int(model.body_geomadr[body])
    for geom in range(first, first + int(model.body_geomnum[body])):
        if model.geom_group[geom] <= VISIBLE_GROUP:
            _add_shapes(link, "visual", model, geom, anchor)
        if model.geom_contype[geom] or model.geom_conaffinity[geom]:
            _add_shapes(link, "collision", model, geom, anchor)


def _add_shapes(
    link: ElementTree.Element,
    kind: str,
    model: mujoco.MjModel,
    geom: int,
    anchor: Array,
) -> None:
    axes = rotation_of(model.geom_quat[geom])
    position = model.geom_pos[geom] - anchor
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    for tag, values, offset in _primitives(model, geom):
        element = _add(link, kind)
        _add_origin(element, position + axes @ offset, axes)
        _add(_add(element, "geometry"), tag, **values)
        if kind == "visual":
            name = "_".join(f"{round(255 * part)}" for part in rgba[:3])
            colour = _add(element, "material", name=f"rgb_{name}")
            _add(colour, "color", rgba=[*rgba[:3], 1.0])


def _primitives(
    model: mujoco.MjModel, geom: int
) -> Iterator[tuple[str, dict[str, Any], Array]]:
    """Yield tag, attributes and position in the frame of a geom."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    none = np.zeros(3)
    if kind == _GEOMS.mjGEOM_BOX:
        yield "box", {"size": 2.0 * size}, none
    elif kind == _GEOMS.mjGEOM_SPHERE:
        yield "sphere", {"radius": size[0]}, none
    elif kind in (_GEOMS.mjGEOM_CYLINDER, _GEOMS.mjGEOM_CAPSULE):
        radius, half = size[0], size[1]
        yield "cylinder", {"radius": radius, "length": 2.0 * half}, none
        if kind == _GEOMS.mjGEOM_CAPSULE:
            for end in (-half, half):
                yield "sphere", {"radius": radius}, np.array([0.0, 0.0, end])
    elif kind == _GEOMS.mjGEOM_ELLIPSOID:
        along = int(np.argmax(size))
        radius = float(np.sqrt(np.delete(size, along).prod()))
        for share in (-1.0, 0.0, 1.0):
            offset = np.zeros(3)
            offset[along] = share * max(float(size[along]) - radius, 0.0)
            yield "sphere", {"radius": radius}, offset
    else:
        center, half_sizes = model.geom_aabb[geom].reshape(2, 3)
        yield "box", {"size": 2.0 * half_sizes}, center


def _effort(model: mujoco.MjModel, joint: UrdfJoint) -> float:
    """Return the greatest torque of a joint's motor, in [N m]."""
    greatest = UNLIMITED
    if model.jnt_actfrclimited[joint.number]:
        greatest = float(np.abs(model.jnt_actfrcrange[joint.number]).max())
    for motor in np.flatnonzero(model.actuator_trnid[:, 0] == joint.number):
        if model.actuator_forcelimited[motor]:
            force = float(np.abs(model.actuator_forcerange[motor]).max())
            gear = abs(float(model.actuator_gear[motor, 0]))
            greatest = min(greatest, force * gear)
    return greatest
