"""URDF of a robot, from the compiled MuJoCo model of its description.

The file needs no other file: shapes are primitives. A capsule becomes a
cylinder with two spheres, an ellipsoid a row of spheres, and any other shape,
such as a mesh, its bounding box. Joint angles mean the same as in the model.
"""

from collections.abc import Iterator
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.player_identity import Colour
from ..core.poses import Array
from ..core.rotations import angles_of, rotation_about, rotation_of
from .description import RobotDescription
from .head import depth_camera_name, load_head
from .robot_tree import HINGE, UNLIMITED, Link
from .tree_cache import load_tree

BASE = "base_link"
SOLES = ("l_sole", "r_sole")  # as in REP 120
IMU = "imu_link"
OPTICAL = "_optical_frame"  # z forward, x right, as in REP 103
CAMERA_AXES = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
FRAMES = (BASE, *SOLES, IMU, "camera", "depth_camera")
VISIBLE_GROUP = 2  # geoms of higher groups are not drawn
_GEOMS = mujoco.mjtGeom
Placement = tuple[Array, Array]  # position [m] and axes as columns
ORIGIN: Placement = np.zeros(3), np.eye(3)


def urdf_of(
    description: RobotDescription, colour: Colour | None = None
) -> str:
    """Return the URDF of a robot, as XML text.

    The root is ``base_link``, at the origin of the torso. Links have the
    names of their bodies, with ``_body`` added to one that is taken; the frame
    of one that moves is at its joint, and parallel to the torso in the zero
    posture. The soles are ``l_sole`` and ``r_sole``; cameras of a described
    head have a frame each, with an optical frame.
    """
    writer = _UrdfWriter(description, colour)
    writer.add_links()
    writer.add_joints()
    writer.add_frames()
    indent(writer.robot)
    header = f"<!-- {description.name}, from {description.path.name} -->\n"
    return header + tostring(writer.robot, encoding="unicode") + "\n"


class _UrdfWriter:
    def __init__(
        self, description: RobotDescription, colour: Colour | None
    ) -> None:
        self._description = description
        self._model = model = description.compile(colour)
        self._data = data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)  # at the zero posture
        self._tree = tree = load_tree(description)
        self._names = [f"{link.joint}_link" for link in tree.links]
        self._torso = torso = model.body(description.torso).id
        # All links are parallel to the torso.
        self._axes = data.xmat[torso].reshape(3, 3)
        self._anchors = [data.xpos[torso]]
        for link in tree.links[1:]:
            offset = self._axes @ link.origin
            self._anchors.append(self._anchors[link.parent] + offset)
        name = "_".join(description.name.lower().split())
        self.robot = Element("robot", name=name)

    def add_links(self) -> None:
        """Add a link for each body, and for hinges without a body."""
        model, data = self._model, self._data
        _add(self.robot, "link", name=BASE)
        bodiless = set(range(len(self._names)))
        under = np.flatnonzero(model.body_rootid == self._torso)
        for body in under.tolist():
            link, moves = self._link_of(body), model.body_weldid[body] == body
            name = model.body(body).name or f"body_{body}"
            name += "_body" if name in FRAMES else ""
            pose = self._in_link(link, data.xpos[body], data.xmat[body])
            if moves:
                bodiless.discard(link)
                self._names[link] = name
            else:
                self._fix(self._names[link], name, pose)
                pose = ORIGIN
            element = _add(self.robot, "link", name=name)
            self._add_body(element, body, pose)
        for link in bodiless:  # simulators want an inertia between two hinges
            element = _add(self.robot, "link", name=self._names[link])
            _add_inertia(element, 1e-6, np.full(3, 1e-9))

    def add_joints(self) -> None:
        """Add the joints that move, with limits and dynamics."""
        model, tree = self._model, self._tree
        self._fix(BASE, self._names[0], ORIGIN)
        for link, child in zip(tree.links[1:], self._names[1:], strict=True):
            limits = {"lower": link.low, "upper": link.high}
            if link.high >= UNLIMITED:
                limits = {}
            position, axes = np.array(link.origin), np.eye(3)
            if link.kind == HINGE:
                kind = "revolute" if limits else "continuous"
                axes = rotation_about(link.axis, -link.zero)
            else:
                kind = "prismatic"
                position -= link.zero * np.array(link.axis)
            parent = self._names[link.parent]
            joint = self._join(link.joint, kind, parent, child, position, axes)
            _add(joint, "axis", xyz=link.axis)
            limits["effort"] = self._effort(link)
            speeds = self._description.speed_limits
            limits["velocity"] = speeds.get(link.joint, UNLIMITED)
            _add(joint, "limit", **limits)
            dof = int(model.joint(link.joint).dofadr[0])
            damping, friction = model.dof_damping, model.dof_frictionloss
            values = {"damping": damping[dof], "friction": friction[dof]}
            _add(joint, "dynamics", **values)
            if link.joint in tree.followers:
                _add(joint, "mimic", joint=tree.followers[link.joint])

    def add_frames(self) -> None:
        """Add soles, IMU and cameras."""
        model, data, own = self._model, self._data, self._description
        gyro = model.site(model.sensor(own.sensors.gyro).objid[0]).id
        feet = [model.site(x).id for x in (own.left_foot, own.right_foot)]
        for name, site in zip((*SOLES, IMU), (*feet, gyro), strict=True):
            place = data.site_xpos[site], data.site_xmat[site]
            self._add_frame(name, model.site_bodyid[site], *place)
        try:
            head = load_head(own)
        except ModelError:
            return  # it has no cameras
        mounts = {"camera": head.top}
        for i, lens in enumerate(head.depth_cameras):
            mounts[depth_camera_name(i)] = lens
        for name, mount in mounts.items():
            body = model.body(head.body_of(mount)).id
            axes = data.xmat[body].reshape(3, 3)
            position = data.xpos[body] + axes @ mount.position_in_body
            self._add_frame(name, body, position, axes @ mount.axes_in_body)
            _add(self.robot, "link", name=name + OPTICAL)
            self._fix(name, name + OPTICAL, (np.zeros(3), CAMERA_AXES))

    def _link_of(self, body: int) -> int:
        """Return the number of the link that carries a body."""
        moving = self._model.body_weldid[body]
        if moving == self._torso:
            return 0
        first, count = (
            int(values[moving])
            for values in (self._model.body_jntadr, self._model.body_jntnum)
        )
        return self._tree.link_of(self._model.joint(first + count - 1).name)

    def _in_link(self, link: int, position: Array, axes: Array) -> Placement:
        offset = position - self._anchors[link]
        return self._axes.T @ offset, self._axes.T @ axes.reshape(3, 3)

    def _add_frame(
        self, name: str, body: int, position: Array, axes: Array
    ) -> None:
        link = self._link_of(body)
        _add(self.robot, "link", name=name)
        place = self._in_link(link, position, axes)
        self._fix(self._names[link], name, place)

    def _fix(self, parent: str, child: str, place: Placement) -> None:
        self._join(f"{child}_fixed", "fixed", parent, child, *place)

    def _join(
        self,
        name: str,
        kind: str,
        parent: str,
        child: str,
        position: Array,
        axes: Array,
    ) -> Element:
        joint = _add(self.robot, "joint", name=name, type=kind)
        _add(joint, "parent", link=parent)
        _add(joint, "child", link=child)
        _add_origin(joint, position, axes)
        return joint

    def _add_body(self, link: Element, body: int, pose: Placement) -> None:
        """Add inertia and shapes of a body at a pose in its link."""
        model, (place, axes) = self._model, pose
        mass = float(model.body_mass[body])
        if mass > 0.0:
            inertial = _add_inertia(link, mass, model.body_inertia[body])
            turned = axes @ rotation_of(model.body_iquat[body])
            _add_origin(inertial, place + axes @ model.body_ipos[body], turned)
        first = int(model.body_geomadr[body])
        for geom in range(first, first + int(model.body_geomnum[body])):
            if model.geom_group[geom] <= VISIBLE_GROUP:
                self._add_shapes(link, "visual", geom, pose)
            if model.geom_contype[geom] or model.geom_conaffinity[geom]:
                self._add_shapes(link, "collision", geom, pose)

    def _add_shapes(
        self, link: Element, kind: str, geom: int, pose: Placement
    ) -> None:
        model, (place, axes) = self._model, pose
        position = place + axes @ model.geom_pos[geom]
        axes = axes @ rotation_of(model.geom_quat[geom])
        material, rgba = model.geom_matid[geom], model.geom_rgba[geom]
        if material >= 0:
            rgba = model.mat_rgba[material]
        for tag, values, offset in _primitives(model, geom):
            element = _add(link, kind)
            _add_origin(element, position + axes @ offset, axes)
            _add(_add(element, "geometry"), tag, **values)
            if kind == "visual":
                name = "_".join(f"{round(255 * part)}" for part in rgba[:3])
                colour = _add(element, "material", name=f"rgb_{name}")
                _add(colour, "color", rgba=[*rgba[:3], 1.0])

    def _effort(self, link: Link) -> float:
        """Return the greatest torque of a joint's motor, in [N m]."""
        model, greatest = self._model, UNLIMITED
        number = model.joint(link.joint).id
        if model.jnt_actfrclimited[number]:
            greatest = float(np.abs(model.jnt_actfrcrange[number]).max())
        for motor in np.flatnonzero(model.actuator_trnid[:, 0] == number):
            if model.actuator_forcelimited[motor]:
                force = float(np.abs(model.actuator_forcerange[motor]).max())
                gear = abs(float(model.actuator_gear[motor, 0]))
                greatest = min(greatest, force * gear)
        return greatest


def _add(parent: Element, tag: str, **values: Any) -> Element:
    """Add an element with texts, numbers and arrays of them."""
    texts = {}
    for name, value in values.items():
        if not isinstance(value, str):
            numbers = np.ravel(value).tolist()
            numbers = [0.0 if abs(x) < 1e-12 else x for x in numbers]
            value = " ".join(f"{x:.12g}" for x in numbers)
        texts[name] = value
    return SubElement(parent, tag, texts)


def _add_origin(parent: Element, position: Array, axes: Array) -> None:
    """Add an origin with roll, pitch and yaw about fixed axes."""
    _add(parent, "origin", xyz=position, rpy=angles_of(axes))


def _add_inertia(link: Element, mass: float, moments: Array) -> Element:
    inertial = _add(link, "inertial")
    _add(inertial, "mass", value=mass)
    x, y, z = moments
    _add(inertial, "inertia", ixx=x, iyy=y, izz=z, ixy=0, ixz=0, iyz=0)
    return inertial


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
