"""A published model with what control needs put on it, file untouched.

It gets a free joint, servos, an IMU, soles with touch sensors and foot
frames; what stands around the robot, what else drives it, and meshes that
cannot be found are left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .description_types import ServoGains, SoleFrame
from .inertia_repair import mend_inertias
from .mesh_files import place_meshes
from .torso_frame import face, matrix_of

if TYPE_CHECKING:
    from .description import RobotDescription

IMU = "stepaside_imu"
THICK = 0.15  # of a sole's box, as a part of its width
# Numbers that the size of a geom needs.
SIZES = {
    int(mujoco.mjtGeom.mjGEOM_SPHERE): 1,
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): 1,
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): 1,
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): 3,
    int(mujoco.mjtGeom.mjGEOM_BOX): 3,
}
SEEN, HIDDEN = 3, 4  # groups of what collides and of what senses


def put_overlay(spec: mujoco.MjSpec, description: RobotDescription) -> None:
    """Put the overlay of a description on its model.

    Args:
        spec: The model as published; it is changed.
        description: The robot.

    Raises:
        ModelError: If the model lacks a body or a joint of the overlay.
    """
    overlay, sensors = description.overlay, description.sensors
    folders = [description.path_of(folder) for folder in overlay.meshes]
    strip(spec, description.torso, description.path, folders)
    face(spec, description.torso, overlay.turn)
    names = (description.left_foot, description.right_foot)
    for site in [s for s in spec.sites if s.name in (*names, *sensors.feet)]:
        spec.delete(site)
    torso = find_body(spec, description.torso)
    imu = torso.add_site(name=IMU)
    _add_sensor(spec, mujoco.mjtSensor.mjSENS_GYRO, sensors.gyro, imu)
    kind = mujoco.mjtSensor.mjSENS_ACCELEROMETER
    _add_sensor(spec, kind, sensors.accelerometer, imu)
    for side, (name, sole) in enumerate(
        zip(names, overlay.soles, strict=True)
    ):
        feet = sensors.feet[4 * side : 4 * side + 4]
        outline = _outline(description.sole, left=side == 0)
        _add_sole(spec, name, sole, outline, feet)
    for joint, gains in overlay.servos.items():
        _add_servo(spec, joint, gains)


def strip(
    spec: mujoco.MjSpec, torso: str, path: Path, folders: list[Path]
) -> list[str]:
    """Leave of a model what is the robot's body, free to move.

    Args:
        spec: The model; it is changed.
        torso: The robot's root.
        path: File of the model.
        folders: Where meshes are looked for besides.

    Returns:
        Files of meshes that are left out, for they cannot be found or read.

    Raises:
        ModelError: If there is no such root.
    """
    spec.compiler.fusestatic = False
    mend_inertias(spec)
    _forget_options(spec)
    world = spec.worldbody
    roots = [body.name for body in world.bodies]
    if torso not in roots:
        raise ModelError(
            f"torso must be a root of {path}, one of {', '.join(roots)}, "
            f"got {torso!r}"
        )
    # What refers to others goes first: MuJoCo takes it away with them.
    for thing in (
        *(*spec.keys, *spec.pairs, *spec.sensors, *spec.actuators),
        *(*world.geoms, *world.lights, *world.cameras, *world.sites),
        *[body for body in world.bodies if body.name != torso],
        *[geom for geom in spec.geoms if _is_empty(geom)],
    ):
        spec.delete(thing)
    for coupling in odd_couplings(spec):
        spec.delete(coupling)
    missing = place_meshes(spec, path, folders)
    root = find_body(spec, torso)
    free = mujoco.mjtJoint.mjJNT_FREE
    if not any(joint.type == free for joint in root.joints):
        for joint in list(root.joints):
            spec.delete(joint)
        root.add_freejoint()
    return missing


def _is_empty(geom: mujoco.MjsGeom) -> bool:
    """Whether a geom has no size, as a mark of a place in some URDF."""
    needed = SIZES.get(int(geom.type), 0)
    return not bool((geom.size[:needed] > 0.0).all())


def odd_couplings(spec: mujoco.MjSpec) -> list[mujoco.MjsEquality]:
    """Equalities between joints that are not simply equal, as of fingers."""
    return [
        each
        for each in spec.equalities
        if each.type == mujoco.mjtEq.mjEQ_JOINT
        and list(each.data[:5]) != [0.0, 1.0, 0.0, 0.0, 0.0]
    ]


def _forget_options(spec: mujoco.MjSpec) -> None:
    """Take back what a model says of physics and light: the world's."""
    plain = mujoco.MjSpec()
    _take(spec.option, plain.option)
    for kind in ("global_", "headlight", "map", "quality", "rgba", "scale"):
        _take(getattr(spec.visual, kind), getattr(plain.visual, kind))
    for name in ("memory", "nconmax", "njmax", "nstack"):
        setattr(spec, name, getattr(plain, name))
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST


def _take(settings: Any, others: Any) -> None:
    """Let settings be like others of their kind."""
    for name in dir(others):
        value = getattr(others, name)
        if name.startswith("_") or callable(value):
            continue
        if isinstance(value, np.ndarray):
            getattr(settings, name)[:] = value
        else:
            setattr(settings, name, value)


def find_body(spec: mujoco.MjSpec, name: str) -> mujoco.MjsBody:
    """Body by its name.

    Raises:
        ModelError: If there is none.
    """
    body = spec.body(name)
    if body is None:
        names = ", ".join(b.name for b in spec.bodies)
        raise ModelError(f"there is no body {name!r}; there are {names}")
    return body


def _outline(sole: dict[str, float], *, left: bool) -> Array:
    """Edges back, front, right, left of a sole in its frame, in [m]."""
    try:
        back, front, outer, inner = (
            sole[name] for name in ("back", "front", "outer", "inner")
        )
    except KeyError as error:
        raise ModelError(f"entry sole.{error.args[0]} is missing") from None
    return np.array(
        [back, front, *((-inner, outer) if left else (-outer, inner))]
    )


def _add_sole(
    spec: mujoco.MjSpec,
    name: str,
    sole: SoleFrame,
    outline: Array,
    feet: tuple[str, ...],
) -> None:
    """Let a foot press on the floor with a box, and feel where it does."""
    body = find_body(spec, sole.body)
    for part in (body, *body.find_all("body")):
        for geom in part.geoms:
            geom.contype = geom.conaffinity = 0
    back, front, right, left = outline.tolist()
    place, turn = np.array(sole.place), np.array(sole.turn)
    axes = matrix_of(turn)
    half = 0.5 * np.array([front - back, left - right, 0.0])
    half[2] = 0.5 * THICK * (left - right)
    middle = np.array([0.5 * (front + back), 0.5 * (left + right), half[2]])
    body.add_geom(
        name=f"{name}_box",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=place + axes @ middle,
        quat=turn,
        size=half,
        mass=0.0,
        group=SEEN,
        contype=1,
        conaffinity=1,
        friction=[0.8, 0.005, 0.0001],
        rgba=[0.3, 0.3, 0.3, 0.4],
    )
    body.add_site(name=name, pos=place, quat=turn)
    corners = ((front, left), (front, right), (back, left), (back, right))
    for foot, (x, y) in zip(feet, corners, strict=True):
        site = body.add_site(
            name=foot,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=place + axes @ np.array([x, y, 0.0]),
            quat=turn,
            size=[0.95 * half[0], 0.95 * half[1], half[2]],
            group=HIDDEN,
            rgba=[0.9, 0.7, 0.1, 0.5],
        )
        _add_sensor(spec, mujoco.mjtSensor.mjSENS_TOUCH, foot, site)


def _add_sensor(
    spec: mujoco.MjSpec,
    kind: mujoco.mjtSensor,
    name: str,
    site: mujoco.MjsSite,
) -> None:
    spec.add_sensor(
        name=name,
        type=kind,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        objname=site.name,
    )


def _add_servo(spec: mujoco.MjSpec, name: str, gains: ServoGains) -> None:
    """Let a position servo move a joint, whatever did before."""
    joint = spec.joint(name)
    if joint is None:
        names = ", ".join(j.name for j in spec.joints)
        raise ModelError(f"there is no joint {name!r}; there are {names}")
    joint.actfrclimited = 0
    # A servo leads its targets by its own damping: there may be no other.
    if isinstance(joint.damping, np.ndarray):
        joint.damping[:] = 0.0
    else:
        joint.damping = 0.0
    if gains.armature > 0.0:
        joint.armature = gains.armature
    servo = spec.add_actuator(name=name)
    servo.target, servo.trntype = name, mujoco.mjtTrn.mjTRN_JOINT
    servo.gaintype = mujoco.mjtGain.mjGAIN_FIXED
    servo.biastype = mujoco.mjtBias.mjBIAS_AFFINE
    servo.gainprm[0] = gains.stiffness
    servo.biasprm[:3] = (0.0, -gains.stiffness, -gains.damping)
    servo.forcelimited = 1
    servo.forcerange = (-gains.torque, gains.torque)
    servo.ctrllimited = 0
