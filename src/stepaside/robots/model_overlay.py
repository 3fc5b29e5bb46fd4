"""Overlay on a published model, whose file is not changed.

The model gets a free joint, servos, an IMU, soles with touch sensors and
foot frames. Its environment, its own actuators and meshes that cannot be
found are removed.
"""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from ..core.rotations import rotation_of
from .description_types import Overlay, SensorNames, ServoGains, SoleFrame
from .model_repair import repair_inertias, resolve_meshes

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


IMU = "stepaside_imu"
THICKNESS = 0.15  # of a sole's box, as a fraction of its width
# Number of size entries that must be positive, by type of geom.
SIZES = {
    int(mujoco.mjtGeom.mjGEOM_SPHERE): 1,
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): 1,
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): 1,
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): 3,
    int(mujoco.mjtGeom.mjGEOM_BOX): 3,
}
COLLISION_GROUP = 3  # of the boxes of the soles
SENSOR_GROUP = 4  # of the sites of touch sensors


def put_overlay(
    spec: mujoco.MjSpec,
    overlay: Overlay,
    *,
    torso: str,
    feet: tuple[str, str],
    sole: dict[str, float],
    sensors: SensorNames,
    path: Path,
    mesh_folders: list[Path],
) -> None:
    """Add foot frames, servos, sensors and torso orientation to a model."""
    strip(spec, torso, path, mesh_folders)
    rotate_torso_frame(spec, torso, overlay.turn)
    for site in [s for s in spec.sites if s.name in (*feet, *sensors.feet)]:
        spec.delete(site)
    imu = find_body(spec, torso).add_site(name=IMU)
    _add_sensor(spec, mujoco.mjtSensor.mjSENS_GYRO, sensors.gyro, imu)
    kind = mujoco.mjtSensor.mjSENS_ACCELEROMETER
    _add_sensor(spec, kind, sensors.accelerometer, imu)
    for side, (name, frame) in enumerate(
        zip(feet, overlay.soles, strict=True)
    ):
        touch_sensors = sensors.feet[4 * side : 4 * side + 4]
        outline = _outline(sole, left=side == 0)
        _add_sole(spec, name, frame, outline, touch_sensors)
    for joint, gains in overlay.servos.items():
        _add_servo(spec, joint, gains)


def strip(
    spec: mujoco.MjSpec, torso: str, path: Path, folders: list[Path]
) -> list[str]:
    """Reduce a model to its floating-base body; return missing meshes."""
    spec.compiler.fusestatic = False
    repair_inertias(spec)
    _reset_options(spec)
    world = spec.worldbody
    roots = [body.name for body in world.bodies]
    if torso not in roots:
        raise ModelError(
            f"torso must be a root of {path}, one of {', '.join(roots)}, "
            f"got {torso!r}"
        )
    # Referring elements first: MuJoCo deletes them with their targets.
    for element in (
        *(*spec.keys, *spec.pairs, *spec.sensors, *spec.actuators),
        *(*world.geoms, *world.lights, *world.cameras, *world.sites),
        *[body for body in world.bodies if body.name != torso],
        *[geom for geom in spec.geoms if _is_empty(geom)],
    ):
        spec.delete(element)
    for coupling in scaled_couplings(spec):
        spec.delete(coupling)
    missing = resolve_meshes(spec, path, folders)
    root = find_body(spec, torso)
    free = mujoco.mjtJoint.mjJNT_FREE
    if not any(joint.type == free for joint in root.joints):
        for joint in list(root.joints):
            spec.delete(joint)
        root.add_freejoint()
    return missing


def _is_empty(geom: mujoco.MjsGeom) -> bool:
    """Return whether a geom has no size, like markers in some URDF files."""
    count = SIZES.get(int(geom.type), 0)
    return not bool((geom.size[:count] > 0.0).all())


def scaled_couplings(spec: mujoco.MjSpec) -> list[mujoco.MjsEquality]:
    """Return joint couplings other than joint1 = joint2, as in fingers."""
    return [
        each
        for each in spec.equalities
        if each.type == mujoco.mjtEq.mjEQ_JOINT
        and list(each.data[:5]) != [0.0, 1.0, 0.0, 0.0, 0.0]
    ]


def _reset_options(spec: mujoco.MjSpec) -> None:
    """Reset the options of physics and rendering, which the world sets."""
    default = mujoco.MjSpec()
    _copy_settings(spec.option, default.option)
    for kind in ("global_", "headlight", "map", "quality", "rgba", "scale"):
        _copy_settings(
            getattr(spec.visual, kind), getattr(default.visual, kind)
        )
    for name in ("memory", "nconmax", "njmax", "nstack"):
        setattr(spec, name, getattr(default, name))
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST


def _copy_settings(settings: Any, source: Any) -> None:
    """Copy all public attributes of a MuJoCo structure."""
    for name in dir(source):
        value = getattr(source, name)
        if name.startswith("_") or callable(value):
            continue
        if isinstance(value, np.ndarray):
            getattr(settings, name)[:] = value
        else:
            setattr(settings, name, value)


def find_body(spec: mujoco.MjSpec, name: str) -> mujoco.MjsBody:
    """Return a body by name; :class:`.ModelError` if there is none."""
    body = spec.body(name)
    if body is None:
        names = ", ".join(b.name for b in spec.bodies)
        raise ModelError(f"there is no body {name!r}; there are {names}")
    return body


def _outline(sole: dict[str, float], *, left: bool) -> Array:
    """Return the edges back, front, right, left of a sole, in [m]."""
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
    touch_sensors: tuple[str, ...],
) -> None:
    """Add a foot site, a box that alone collides, and touch sensors."""
    body = find_body(spec, sole.body)
    for part in (body, *body.find_all("body")):
        for geom in part.geoms:
            geom.contype = geom.conaffinity = 0
    back, front, right, left = outline.tolist()
    place, turn = np.array(sole.place), np.array(sole.turn)
    axes = rotation_of(turn)
    half = 0.5 * np.array([front - back, left - right, 0.0])
    half[2] = 0.5 * THICKNESS * (left - right)
    middle = np.array([0.5 * (front + back), 0.5 * (left + right), half[2]])
    body.add_geom(
        name=f"{name}_box",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=place + axes @ middle,
        quat=turn,
        size=half,
        mass=0.0,
        group=COLLISION_GROUP,
        contype=1,
        conaffinity=1,
        friction=[0.8, 0.005, 0.0001],
        rgba=[0.3, 0.3, 0.3, 0.4],
    )
    body.add_site(name=name, pos=place, quat=turn)
    corners = ((front, left), (front, right), (back, left), (back, right))
    for sensor, (x, y) in zip(touch_sensors, corners, strict=True):
        site = body.add_site(
            name=sensor,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=place + axes @ np.array([x, y, 0.0]),
            quat=turn,
            size=[0.95 * half[0], 0.95 * half[1], half[2]],
            group=SENSOR_GROUP,
            rgba=[0.9, 0.7, 0.1, 0.5],
        )
        _add_sensor(spec, mujoco.mjtSensor.mjSENS_TOUCH, sensor, site)


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
    """Drive a joint by a position servo."""
    joint = spec.joint(name)
    if joint is None:
        names = ", ".join(j.name for j in spec.joints)
        raise ModelError(f"there is no joint {name!r}; there are {names}")
    joint.actfrclimited = 0
    # Target feedforward compensates the damping of the servo alone.
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
