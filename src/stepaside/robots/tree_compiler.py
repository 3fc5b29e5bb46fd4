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
    torso = model.body(description.torso).id
    first = int(model.body_jntadr[torso])
    if first < 0 or model.jnt_type[first] != mujoco.mjtJoint.mjJNT_FREE:
        raise ModelError(
            f"torso of {description.name}: body {description.torso!r} "
            "has no free joint"
        )
    origin, axes = data.xpos[torso], data.xmat[torso].reshape(3, 3)
    links, anchors, carriers = [TORSO], [np.zeros(3)], dict[int, int]()
    for body in np.flatnonzero(model.body_rootid == torso).tolist():
        link = carriers.get(int(model.body_parentid[body]), 0)
        first = int(model.body_jntadr[body])
        joints = range(first, first + int(model.body_jntnum[body]))
        for joint in joints if body != torso else ():
            anchor = axes.T @ (data.xanchor[joint] - origin)
            axis, offset = axes.T @ data.xaxis[joint], anchor - anchors[link]
            found = _link(model, joint, link, description.name)
            found = found._replace(axis=_clean(axis), origin=_clean(offset))
            links.append(found)
            anchors.append(anchor)
            link = len(links) - 1
        carriers[body] = link
        mass, old = float(model.body_mass[body]), links[link]
        com = axes.T @ (data.xipos[body] - origin) - anchors[link]
        if (total := old.mass + mass) > 0.0:
            com = (old.mass * np.array(old.com) + mass * com) / total
            links[link] = old._replace(mass=total, com=_clean(com))

    def frame(body: int, position: Array, own: Array) -> LinkFrame:
        x, y, z = axes.T @ own.reshape(3, 3)
        link = carriers[body]
        place = axes.T @ (position - origin) - anchors[link]
        return LinkFrame(
            link, _clean(place), (_clean(x), _clean(y), _clean(z))
        )

    return RobotTree(
        tuple(links),
        {
            model.body(b).name: frame(b, data.xpos[b], data.xmat[b])
            for b in carriers
        },
        {
            model.site(i).name: frame(b, data.site_xpos[i], data.site_xmat[i])
            for i, b in enumerate(model.site_bodyid.tolist())
            if b in carriers
        },
        tuple(model.joint(i).name for i in model.actuator_trnid[:, 0]),
        tuple(_servo(model, i) for i in range(model.nu)),
        coupled_joints(model, description.name),
        _size_of(model, description),
    )


def _link(model: mujoco.MjModel, joint: int, parent: int, robot: str) -> Link:
    """Return the link of a joint, without its geometry and mass."""
    name = model.joint(joint).name
    kind = KINDS.get(int(model.jnt_type[joint]))
    if kind is None:
        raise ModelError(
            f"joint {name!r} of {robot} must be a hinge or a slide"
        )
    low, high = model.jnt_range[joint].tolist()
    if not model.jnt_limited[joint]:
        low, high = -UNLIMITED, UNLIMITED
    zero = float(model.qpos0[model.jnt_qposadr[joint]])
    return Link(name, parent, kind, ZERO, ZERO, zero, low, high, 0.0, ZERO)


def _servo(model: mujoco.MjModel, actuator: int) -> Servo:
    """Return the gains of torque = k (target - q) - d q'."""
    gain = float(model.actuator_gainprm[actuator, 0])
    _, by_angle, by_speed = model.actuator_biasprm[actuator, :3]
    if gain <= 0.0 or by_angle != -gain:
        return Servo(0.0, 0.0)
    return Servo(gain, -float(by_speed))


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


def coupled_joints(model: mujoco.MjModel, robot: str) -> dict[str, str]:
    """Return the joints that share a motor, as follower to leader."""
    coupled = {}
    for i in range(model.neq):
        if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT:
            continue
        follower = model.joint(model.eq_obj1id[i]).name
        leader = model.joint(model.eq_obj2id[i]).name
        if model.eq_data[i, :5].tolist() != [0.0, 1.0, 0.0, 0.0, 0.0]:
            raise ModelError(
                f"joints {follower} and {leader} of {robot} must be coupled "
                "with polycoef 0 1 0 0 0, "
                f"got {model.eq_data[i, :5].tolist()}"
            )
        coupled[follower] = leader
    return coupled
