"""Overlay on a published model, whose file is not changed.

The model gets a free joint, servos, an IMU, soles with touch sensors and
foot frames. Its environment, its own actuators and meshes that cannot be
found are removed, and impossible inertias are repaired.
"""

from collections.abc import Iterator
from os.path import isfile, join
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from ..core.rotations import rotation_of
from .description_types import Overlay, SensorNames, ServoGains, SoleFrame

IDENTITY = (1.0, 0.0, 0.0, 0.0)
IMU = "stepaside_imu"
THICKNESS = 0.15  # of a sole's box, as a fraction of its width
COLLISION_GROUP = 3  # of the boxes of the soles
SENSOR_GROUP = 4  # of the sites of touch sensors
_GEOMS = mujoco.mjtGeom
# Number of size entries that must be positive, by type of geom.
SIZES = {
    int(_GEOMS.mjGEOM_SPHERE): 1,
    int(_GEOMS.mjGEOM_CAPSULE): 1,
    int(_GEOMS.mjGEOM_CYLINDER): 1,
    int(_GEOMS.mjGEOM_ELLIPSOID): 3,
    int(_GEOMS.mjGEOM_BOX): 3,
}
MESH_SUFFIXES = (".stl", ".obj", ".msh")  # of formats that MuJoCo reads
PACKAGE = "package://"
LEAST_MASS = 1e-6  # of a link, in [kg]
LEAST_RATIO = 1e-3  # of the least to the greatest moment of inertia
LEAST_GYRATION = 1e-4  # smaller radii of gyration are replaced, in [m]
DEFAULT_RADIUS = 0.02  # of the ball that replaces them, in [m]
NEGLIGIBLE_MASS = 1e-4  # links below have no effect, in [kg]
# Radius of gyration beyond which units must be wrong, by the length of the
# longest chain of the robot.
GREATEST_GYRATION = 2.0
TYPICAL_GYRATION = 0.4  # radius of gyration of a link by its length


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
    imu = _find(spec, "body", torso).add_site(name=IMU)
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
    default = mujoco.MjSpec()  # the world sets physics and rendering
    spec.option, spec.visual = default.option, default.visual
    for name in ("memory", "nconmax", "njmax", "nstack"):
        setattr(spec, name, getattr(default, name))
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
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
    missing = _resolve_meshes(spec, path, folders)
    root = spec.body(torso)
    free = mujoco.mjtJoint.mjJNT_FREE
    if not any(joint.type == free for joint in root.joints):
        for joint in list(root.joints):
            spec.delete(joint)
        root.add_freejoint()
    return missing


def _is_empty(geom: mujoco.MjsGeom) -> bool:
    """Return whether a geom has no size, like markers in some URDF files."""
    return not bool((geom.size[: SIZES.get(int(geom.type), 0)] > 0.0).all())


def scaled_couplings(spec: mujoco.MjSpec) -> list[mujoco.MjsEquality]:
    """Return joint couplings other than joint1 = joint2, as in fingers."""
    return [
        each
        for each in spec.equalities
        if each.type == mujoco.mjtEq.mjEQ_JOINT
        and list(each.data[:5]) != [0.0, 1.0, 0.0, 0.0, 0.0]
    ]


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
        axes = rotation_of(quaternion)
        root.ipos[:] = axes @ np.array(root.ipos)
        if np.isnan(root.fullinertia).any():
            turned = np.zeros(4)
            mujoco.mju_mulQuat(turned, quaternion, np.array(root.iquat))
            root.iquat[:] = turned
        else:
            _set_inertia(root, axes @ _inertia_of(root) @ axes.T)


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
    body = _find(spec, "body", sole.body)
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
    joint = _find(spec, "joint", name)
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


def _find(spec: mujoco.MjSpec, kind: str, name: str) -> Any:
    """Return a body or a joint by name."""
    found = getattr(spec, kind)(name)
    if found is None:
        all_of = spec.bodies if kind == "body" else spec.joints
        names = ", ".join(each.name for each in all_of)
        raise ModelError(f"there is no {kind} {name!r}; there are {names}")
    return found


def _resolve_meshes(
    spec: mujoco.MjSpec, path: Path, folders: list[Path]
) -> list[str]:
    """Replace the mesh files of a model by absolute paths.

    A file is looked up as the model names it, then by name in the folders.
    Meshes that are missing or unreadable are returned and deleted.
    """
    by_name: dict[str, Path] = {}
    for folder in folders:
        for file in sorted(folder.rglob("*")):
            by_name.setdefault(file.name, file)
    mesh_folder = path.parent / spec.meshdir
    above = [str(folder) for folder in path.resolve().parents]
    missing: list[str] = []
    for mesh in list(spec.meshes):
        if not mesh.file:
            continue  # vertices are in the model itself
        file = Path(mesh.file)
        candidates = (
            mesh_folder / file,
            path.parent / file,
            *_in_ros_package(above, mesh.file),
            by_name.get(file.name, mesh_folder / file.name),
        )
        found = next((Path(p) for p in candidates if isfile(p)), None)
        shown = mesh.name or file.stem
        shapes = [geom for geom in spec.geoms if geom.meshname == shown]
        if found is None or not _is_readable(found):
            missing.append(mesh.file)
            for element in (*shapes, mesh):
                spec.delete(element)
            continue
        mesh.file = str(found.resolve())
        # MuJoCo refuses flat or open solids; shells may be massless.
        if all(geom.parent.explicitinertial for geom in shapes):
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    return missing


def _in_ros_package(above: list[str], file: str) -> Iterator[str]:
    """Yield the candidates of a ``package://`` file in folders above."""
    if file.startswith(PACKAGE):
        package, _, rest = file.removeprefix(PACKAGE).partition("/")
        for folder in above:
            yield join(folder, package, rest)
            yield join(folder, rest)


def _is_readable(file: Path) -> bool:
    """Return whether MuJoCo reads a file; STL only if it is binary."""
    if file.suffix.lower() not in MESH_SUFFIXES:
        return False
    if file.suffix.lower() != ".stl":
        return True
    with file.open("rb") as stream:
        head = stream.read(84)
    faces = int.from_bytes(head[80:84], "little")
    return file.stat().st_size == 84 + 50 * faces


def repair_inertias(spec: mujoco.MjSpec) -> None:
    """Give every link a valid mass and inertia.

    Links without mass get a millionth of a kilogram. Inertias that are not
    positive definite keep their axes and get positive moments. If the radius
    of gyration of a link exceeds the size of the robot, units are wrong, and
    all inertias that are too large become typical ones for their links.
    """
    spec.compiler.boundmass = LEAST_MASS
    spec.compiler.boundinertia = LEAST_MASS * DEFAULT_RADIUS**2
    spec.compiler.balanceinertia = True
    _shrink_inertias(spec)
    for body in spec.bodies:
        if not body.explicitinertial or np.isnan(body.fullinertia).any():
            continue
        moments, axes = np.linalg.eigh(_inertia_of(body))
        mass = max(float(body.mass), LEAST_MASS)
        if moments[0] > mass * LEAST_GYRATION**2:
            continue
        least = LEAST_RATIO * float(moments[2])
        if moments[2] <= mass * LEAST_GYRATION**2:
            least = 0.4 * mass * DEFAULT_RADIUS**2
        _set_inertia(body, axes @ np.diag(np.maximum(moments, least)) @ axes.T)


def _shrink_inertias(spec: mujoco.MjSpec) -> None:
    """Shrink too large inertias of a model whose units must be wrong."""
    gyrations, lengths, depths = {}, dict[str, float](), dict[str, float]()
    longest = 0.0
    for body in spec.bodies:  # parents come before their children
        above = body.parent.name if body.parent else ""
        # To the farthest child; for a tip, or a link of crossing axes, as long
        # as the link above it.
        below = [float(np.linalg.norm(child.pos)) for child in body.bodies]
        own = max(below, default=0.0)
        lengths[body.name] = own or lengths.get(above, 0.0)
        if above in depths:
            depths[body.name] = depths[above] + float(np.linalg.norm(body.pos))
            longest = max(longest, depths[body.name])
        elif body.parent:  # a root
            depths[body.name] = 0.0
        if body.explicitinertial and body.mass > NEGLIGIBLE_MASS:
            most = float(np.linalg.eigvalsh(_inertia_of(body)).max())
            gyrations[body.name] = float(np.sqrt(max(most, 0.0) / body.mass))
    if max(gyrations.values(), default=0.0) <= GREATEST_GYRATION * longest:
        return
    for body in spec.bodies:
        length = lengths[body.name]
        if gyrations.get(body.name, 0.0) > length > 0.0:
            moment = float(body.mass) * (TYPICAL_GYRATION * length) ** 2
            if np.isnan(body.fullinertia).any():
                body.inertia[:] = moment
            else:
                _set_inertia(body, moment * np.eye(3))


def _inertia_of(body: mujoco.MjsBody) -> Array:
    """Return the inertia matrix, about its axes if it is given by moments."""
    if np.isnan(body.fullinertia).any():
        return np.diag(np.array(body.inertia))
    xx, yy, zz, xy, xz, yz = np.array(body.fullinertia).tolist()
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _set_inertia(body: mujoco.MjsBody, inertia: Array) -> None:
    body.fullinertia[:] = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
