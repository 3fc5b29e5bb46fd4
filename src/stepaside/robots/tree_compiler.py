"""Compilation of a MuJoCo model to a kinematic tree."""

from typing import Any

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .description import RobotDescription
from .geom_points import geom_points_in_world
from .robot_tree import (
    HINGE,
    SLIDE,
    UNLIMITED,
    BodySize,
    Link,
    LinkFrame,
    RobotTree,
    Servo,
    Triple,
)

KINDS = {
    int(mujoco.mjtJoint.mjJNT_HINGE): HINGE,
    int(mujoco.mjtJoint.mjJNT_SLIDE): SLIDE,
}
ZERO = (0.0, 0.0, 0.0)
TORSO = Link("", -1, "", ZERO, ZERO, 0.0, 0.0, 0.0, 0.0, ZERO)
DECIMALS = 14  # to which numbers are rounded: 0 and 1 become exact


def compile_tree(description: RobotDescription) -> RobotTree:
    """Compile the model of a robot and extract its kinematic tree."""
    model = description.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)  # at the zero posture
    return _TreeExtractor(model, data, description).tree()


class _TreeExtractor:
    """Extraction of the tree from a compiled model in its zero posture."""

    def __init__(
        self, model: Any, data: Any, description: RobotDescription
    ) -> None:
        self._model, self._data = model, data
        self._description = description
        self._torso = torso = model.body(description.torso).id
        first = int(model.body_jntadr[torso])
        free = int(mujoco.mjtJoint.mjJNT_FREE)
        if first < 0 or model.jnt_type[first] != free:
            raise ModelError(
                f"torso of {description.name}: body {description.torso!r} "
                "has no free joint"
            )
        self._origin = data.xpos[torso].copy()
        self._axes = data.xmat[torso].reshape(3, 3).copy()
        self._links, self._anchors = [TORSO], [np.zeros(3)]
        self._link_of_body: dict[int, int] = {}

    def tree(self) -> RobotTree:
        """Extract links, frames and motors."""
        model = self._model
        self._add_mass(self._torso, 0)
        for body in range(self._torso + 1, model.nbody):
            parent = int(model.body_parentid[body])
            if parent in self._link_of_body:
                link = self._link_of_body[parent]
                first = int(model.body_jntadr[body])
                for i in range(int(model.body_jntnum[body])):
                    link = self._add_joint(first + i, link)
                self._add_mass(body, link)
        bodies = {
            model.body(b).name: self._frame(
                link, self._data.xpos[b], self._data.xmat[b]
            )
            for b, link in self._link_of_body.items()
        }
        sites = {
            model.site(i).name: self._frame(
                self._link_of_body[int(model.site_bodyid[i])],
                self._data.site_xpos[i],
                self._data.site_xmat[i],
            )
            for i in range(model.nsite)
            if int(model.site_bodyid[i]) in self._link_of_body
        }
        motors = tuple(
            model.joint(model.actuator_trnid[i, 0]).name
            for i in range(model.nu)
        )
        return RobotTree(
            tuple(self._links),
            bodies,
            sites,
            motors,
            tuple(self._servo(i) for i in range(model.nu)),
            self._description.coupled_joints(model),
            _size_of(model, self._description),
        )

    def _servo(self, actuator: int) -> Servo:
        """Return the gains of torque = k (target - q) - d q'."""
        gain = float(self._model.actuator_gainprm[actuator, 0])
        _, by_angle, by_speed = self._model.actuator_biasprm[actuator, :3]
        if gain <= 0.0 or by_angle != -gain:
            return Servo(0.0, 0.0)
        return Servo(gain, -float(by_speed))

    def _add_joint(self, joint: int, parent: int) -> int:
        model, data = self._model, self._data
        name = model.joint(joint).name
        kind = KINDS.get(int(model.jnt_type[joint]))
        if kind is None:
            raise ModelError(
                f"joint {name!r} of {self._description.name} must be a hinge "
                "or a slide"
            )
        anchor = self._to_torso(data.xanchor[joint])
        low, high = model.jnt_range[joint].tolist()
        if not model.jnt_limited[joint]:
            low, high = -UNLIMITED, UNLIMITED
        self._links.append(
            Link(
                name,
                parent,
                kind,
                _clean(self._axes.T @ data.xaxis[joint]),
                _clean(anchor - self._anchors[parent]),
                float(model.qpos0[model.jnt_qposadr[joint]]),
                low,
                high,
                *(0.0, ZERO),
            )
        )
        self._anchors.append(anchor)
        return len(self._links) - 1

    def _add_mass(self, body: int, link: int) -> None:
        """Weld a body to a link."""
        self._link_of_body[body] = link
        mass = float(self._model.body_mass[body])
        com = self._to_torso(self._data.xipos[body]) - self._anchors[link]
        old = self._links[link]
        total = old.mass + mass
        if total > 0.0:
            com = (old.mass * np.array(old.com) + mass * com) / total
            self._links[link] = old._replace(mass=total, com=_clean(com))

    def _frame(self, link: int, position: Array, axes: Array) -> LinkFrame:
        x, y, z = self._axes.T @ axes.reshape(3, 3)
        return LinkFrame(
            link,
            _clean(self._to_torso(position) - self._anchors[link]),
            (_clean(x), _clean(y), _clean(z)),
        )

    def _to_torso(self, position: Array) -> Array:
        in_torso: Array = self._axes.T @ (position - self._origin)
        return in_torso


def _size_of(model: Any, description: RobotDescription) -> BodySize:
    """Measure the shapes of a standing robot."""
    data, torso = mujoco.MjData(model), model.body(description.torso).id
    for joint, angle in description.standing.items():
        data.joint(joint).qpos[0] = angle
    mujoco.mj_kinematics(model, data)
    feet = (description.left_foot, description.right_foot)
    floor = min(data.site(foot).xpos[2] for foot in feet)
    parts = [
        geom_points_in_world(model, data, geom)
        - (*data.xpos[torso, :2], floor)
        for geom in range(model.ngeom)
    ]
    x, y, z = np.concatenate([np.zeros((1, 3)), *parts]).T
    height, radius = float(z.max()), float(np.hypot(x, y).max())
    painted = [
        part[:, 2]
        for part, material in zip(parts, model.geom_matid, strict=True)
        if material >= 0
        and model.material(material).name == description.accent
    ]
    size = BodySize(round(height, 4), round(radius, 4))
    if not painted:
        return size
    ends = np.concatenate(painted)
    trim = round(float(ends.min()), 4), round(float(ends.max()), 4)
    return size._replace(trim=trim)


def _clean(numbers: Array) -> Triple:
    """Round to remove the noise of rotations."""
    x, y, z = (np.round(numbers, DECIMALS) + 0.0).tolist()
    return x, y, z
