"""Analysis of a published model: torso, legs, soles and orientation.

In the zero posture its feet need not be level. The sole is the largest flat
side of the convex hull of a foot that faces downward.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ..core.errors import ModelError
from ..core.poses import Array
from ..robots.geom_points import geom_points_in_world
from ..robots.model_overlay import scaled_couplings, strip
from ..robots.model_reader import read_model

SOLE_THICKNESS = 0.012  # of the points of a sole, by the length of the leg
GREATEST_TILT = np.cos(np.radians(40.0))  # of a sole in the zero posture
SAME_SIDE = np.cos(np.radians(2.0))  # angle of faces that count as one side
LEVEL_TILT = np.sin(np.radians(1.0))  # smaller tilts count as level
ITERATIONS = 4  # of the tilt: round geoms touch at other points when tilted
# Plausible length and width of a sole by the length of the leg.
LENGTHS = (0.1, 0.8)
WIDTHS = (0.03, 0.6)
# Height of an ankle and edges of a sole by the length of the leg.
GUESS = (0.12, -0.12, 0.22, -0.09, 0.09)


def sole_of(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    hip: Array,
    ankle: Array,
) -> tuple[float, tuple[float, float, float, float], bool, Array]:
    """Find the sole of a foot, with hip and ankle in [m].

    Its height, outline, whether they are a guess, and the axes of the foot,
    as in :class:`DetectedLeg`.
    """
    points, axes = foot_points(model, data, body), np.eye(3)
    if len(points) == 1:
        length = float(hip[2] - ankle[2])
        height, back, front, right, left = (x * length for x in GUESS)
        outline = back, front, right, left
        return float(ankle[2]) - height, outline, True, axes
    for _ in range(ITERATIONS):
        down = _downward(points)
        if down is None:
            break
        axes = _standing_on(axes @ down)
        points = foot_points(model, _turned(model, data, axes.T), body)
    level_ankle = axes.T @ ankle
    low = float(points[:, 2].min())
    length = float((axes.T @ hip)[2] - low)
    flat = points[points[:, 2] < low + SOLE_THICKNESS * length] - level_ankle
    (back, right), (front, left) = (
        flat[:, :2].min(axis=0).tolist(),
        flat[:, :2].max(axis=0).tolist(),
    )
    outline = back, front, right, left
    violation = check_size(outline, length)
    if not violation and not (back < 0.0 < front and right < 0.0 < left):
        got = ", ".join(f"{edge:.3f}" for edge in outline)
        violation = f"must be under its ankle, got edges {got} [m] from it"
    if violation:
        raise ModelError(
            f"the sole of {model.body(body).name!r} {violation}: its geoms "
            "have no flat side that the robot could stand on"
        )
    height = float(level_ankle[2]) - low
    return float(ankle[2]) - height, outline, False, axes


def foot_points(
    model: mujoco.MjModel, data: mujoco.MjData, body: int
) -> Array:
    """Return the surface points of a foot: of colliding geoms if any.

    Positions, in [m]; that of the body if it has no geoms. Shape (n, 3).
    """
    parts = [body]
    for other in range(body + 1, model.nbody):
        if int(model.body_parentid[other]) in parts:
            parts.append(other)
    own = np.isin(model.geom_bodyid, parts)
    touching = own & ((model.geom_contype | model.geom_conaffinity) != 0)
    geoms = np.flatnonzero(touching if touching.any() else own)
    found = [geom_points_in_world(model, data, int(geom)) for geom in geoms]
    found = [points for points in found if len(points)]
    if not found:
        return np.array([data.xpos[body]])
    return np.concatenate(found)


def check_size(edges: tuple[float, ...], length: float) -> str:
    """Return the violation of the size limits of a sole; empty if none."""
    back, front, right, left = edges
    sizes = ((front - back, LENGTHS, "long"), (left - right, WIDTHS, "wide"))
    for size, (least, most), how in sizes:
        if not least * length <= size <= most * length:
            return (
                f"must be {least * length:.3f} to {most * length:.3f} m {how} "
                f"for legs of {length:.2f} m, got {size:.3f}"
            )
    return ""


def _downward(points: Array) -> Array | None:
    """Return the outward normal of the sole; None if it is vertical.

    Shape (3,).
    """
    try:
        hull = ConvexHull(points)
    except QhullError:  # all in one plane
        return None
    normals = hull.equations[:, :3]
    corners = points[hull.simplices]
    spans = corners[:, 1:] - corners[:, :1]
    areas = 0.5 * np.linalg.norm(np.cross(spans[:, 0], spans[:, 1]), axis=1)
    downward = -normals[:, 2] >= GREATEST_TILT
    normals, areas = normals[downward], areas[downward]
    if not len(areas):
        return None
    best, down = 0.0, normals[0]
    for i in np.argsort(-areas)[:40]:
        area = float(areas[normals @ normals[i] > SAME_SIDE].sum())
        if area > best * (1.0 + 1e-9):
            best, down = area, normals[i]
    is_level = np.hypot(down[0], down[1]) < LEVEL_TILT
    return None if is_level else down


def _standing_on(down: Array) -> Array:
    """Return the axes of a foot whose sole has a given normal."""
    forward = np.cross((0.0, 1.0, 0.0), -down)
    forward /= np.linalg.norm(forward)
    return np.stack([forward, np.cross(-down, forward), -down], axis=1)


def _turned(
    model: mujoco.MjModel, data: mujoco.MjData, matrix: Array
) -> mujoco.MjData:
    """Return the posture with the torso rotated by a matrix."""
    turned = mujoco.MjData(model)
    turned.qpos[:] = data.qpos
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, matrix.ravel())
    mujoco.mju_mulQuat(turned.qpos[3:7], turn, data.qpos[3:7].copy())
    mujoco.mj_kinematics(model, turned)
    return turned


ALIGNED = 0.8  # least direction cosine of a joint axis with its frame axis
INCLINED = 0.5  # likewise of an inclined joint axis
FAR_APART = 0.1  # distance of ankle axes beyond which one is moved, by leg
JOINT_TYPES = (
    int(mujoco.mjtJoint.mjJNT_HINGE),
    int(mujoco.mjtJoint.mjJNT_SLIDE),
)


class NoLegsError(ModelError):
    """The model does not have two legs."""


class DetectedLeg(NamedTuple):
    """One leg in the zero posture, in the torso frame."""

    joints: tuple[str, ...]  # joints between torso and foot
    pitches: tuple[str, ...]  # pitch joints of hip, knee and ankle
    # sign of each pitch axis along the axis to the left
    signs: tuple[float, ...]
    foot: str
    hip: Array  # mean position of the first three joints [m]. Shape (3,)
    ankle: Array  # position of the last joint [m]. Shape (3,)
    sole: float  # height of the sole of the levelled foot [m]
    # edges of the sole from the ankle [m]: back, front, right, left
    outline: tuple[float, float, float, float]
    # whether sole and outline are a guess, because the foot has no geoms
    is_guessed: bool
    # axes forward, left and up of the standing foot, as columns. Shape (3, 3)
    axes: Array
    pivots: Array  # positions of the pitch joints [m]. Shape (3, 3)


def find_legs(
    model: mujoco.MjModel, data: mujoco.MjData, path: Path
) -> tuple[DetectedLeg, DetectedLeg]:
    """Find the left and right leg of a robot."""
    ends = _ends(model)
    low = {b: float(foot_points(model, data, b)[:, 2].min()) for b in ends}
    sides = [
        [body for body in ends if side * data.xpos[body, 1] > 0.0]
        for side in (1.0, -1.0)
    ]
    if not all(sides):
        found = np.abs(data.xpos[ends].mean(axis=0)) if ends else np.zeros(3)
        reason = (
            f"each side must have a joint chain that ends there, got "
            f"{len(sides[0])} to the left and {len(sides[1])} to the right of "
            "the torso origin; the z axis of the torso must point up, and its "
            "x or y axis forward"
        )
        if not ends:
            reason = (
                "no body below its torso has a hinge or a slide; the torso "
                "must be the root body with the most descendants"
            )
        elif found.argmax() != 2:
            reason = (
                f"it stands along the {'xy'[found.argmax()]} axis of its "
                "torso, whose z axis must point up"
            )
        raise NoLegsError(f"{path} does not have two legs: {reason}")
    left, right = (min(bodies, key=lambda body: low[body]) for bodies in sides)
    near, far = _chain(model, left), _chain(model, right)
    own, other = (
        [joint for joint in chain if joint not in shared]
        for chain, shared in ((near, far), (far, near))
    )
    return (
        _leg(model, data, left, own, "left"),
        _leg(model, data, right, other, "right"),
    )


def _above(model: mujoco.MjModel, body: int) -> Iterator[int]:
    while body := int(model.body_parentid[body]):
        yield body


def _ends(model: mujoco.MjModel) -> list[int]:
    """Return the bodies with joints that have no jointed descendants."""
    moving = np.isin(model.jnt_type, JOINT_TYPES) & (model.jnt_bodyid > 1)
    jointed = set(model.jnt_bodyid[moving].tolist())
    return sorted(jointed - {b for own in jointed for b in _above(model, own)})


def _chain(model: mujoco.MjModel, body: int) -> list[int]:
    bodies = body, *_above(model, body)
    moving = np.isin(model.jnt_type, JOINT_TYPES)
    found: list[int] = np.flatnonzero(
        moving & np.isin(model.jnt_bodyid, bodies)
    ).tolist()
    return found


def _lacking(data: mujoco.MjData, chain: list[int], knee: int) -> list[str]:
    """Return the names of missing yaw and roll joints of a leg."""
    at = chain.index(knee)
    return [
        name
        for name, joints, axis in (
            ("hip yaw", chain[:at], 2),
            ("hip roll", chain[:at], 0),
            ("ankle roll", chain[at + 1 :], 0),
        )
        if not (np.abs(data.xaxis[joints, axis]) > INCLINED).any()
    ]


def _ankle(
    data: mujoco.MjData, chain: list[int], pitch: int, hip: Array
) -> Array:
    """Return the position of the ankle, in [m]. Shape (3,).

    It is the point of the last axis nearest to the other ankle axis; for a
    final roll joint, only if its anchor is far from there.
    """
    last = chain[-1]
    anchor: Array = data.xanchor[last].copy()
    axis = data.xaxis[last]
    if last == pitch:
        roll = chain[-2]
        if abs(data.xaxis[roll, 0]) < ALIGNED:
            return anchor
        across: Array = data.xanchor[roll] - anchor
        crossing: Array = anchor + float(across @ axis) * axis
        return crossing
    along = float((data.xanchor[pitch] - anchor) @ axis)
    if abs(axis[0]) < ALIGNED or abs(along) < FAR_APART * (hip - anchor)[2]:
        return anchor
    ankle: Array = anchor + along * axis
    return ankle


def _leg(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    chain: list[int],
    side: str,
) -> DetectedLeg:
    pitches = [j for j in chain if abs(data.xaxis[j, 1]) > ALIGNED]
    if len(pitches) == 4 and pitches[3] == chain[-1] and len(chain) > 6:
        # A toe joint: kept fixed, so that the toe is part of the foot.
        chain, pitches = chain[:-1], pitches[:-1]
        body = int(model.jnt_bodyid[chain[-1]])
    name = model.body(body).name
    names = ", ".join(model.joint(j).name for j in chain)
    if len(pitches) != 3:
        raise ModelError(
            f"no leg found on the {side}: the lowest chain of joints ends in "
            f"{name!r}; a leg must have a pitch joint at hip, knee and "
            f"ankle, got {len(chain)} joints of which {len(pitches)} turn "
            f"about the axis to the left: {names}"
        )
    lacking = _lacking(data, chain, pitches[1])
    if len(chain) < 6:
        raise ModelError(
            f"the lowest chain of joints on the {side} ends in {name!r} and "
            "must have at least 6 joints to place a foot, got "
            f"{len(chain)} and no "
            f"{' and no '.join(lacking) or 'other'}: {names}"
        )
    hip = data.xanchor[chain[:3]].mean(axis=0)
    ankle = _ankle(data, chain, pitches[2], hip)
    return DetectedLeg(
        tuple(model.joint(j).name for j in chain),
        tuple(model.joint(j).name for j in pitches),
        tuple(float(np.sign(data.xaxis[j, 1])) for j in pitches),
        name,
        hip,
        ankle,
        *sole_of(model, data, body, hip, ankle),
        data.xanchor[pitches].copy(),
    )


LEAST_ASYMMETRY = 0.1  # of a sole about its ankle, by its length
KNEE_WEIGHT = 0.3  # of a knee that bends one way, by the asymmetry of a sole
WIDEST = 4.0 * np.pi  # range of a leg joint; a wider one is in [deg]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False)
class ModelAnalysis:
    """The robot in a published model, and its legs."""

    path: Path  # file of the model
    model: mujoco.MjModel  # compiled model of the robot alone
    # zero posture, with the torso at the origin, facing forward
    data: mujoco.MjData
    torso: str  # body that carries the free joint
    legs: tuple[DetectedLeg, DetectedLeg]  # left and right leg
    missing: tuple[str, ...]  # mesh files that are missing or cannot be read
    # of the published torso in axes (forward, left, up)
    turn: Quaternion = (1.0, 0.0, 0.0, 0.0)

    @property
    def mass(self) -> float:
        """Mass of the robot, in [kg]."""
        return float(self.model.body_mass.sum())

    @property
    def length(self) -> float:
        """Mean length of the legs from hip to sole, in [m]."""
        return float(np.mean([leg.hip[2] - leg.sole for leg in self.legs]))

    @property
    def joints(self) -> list[str]:
        """Names of the hinges and slides of the robot."""
        model = self.model
        return [
            model.joint(i).name
            for i in range(model.njnt)
            if model.jnt_type[i] in JOINT_TYPES
        ]


def analyse_model(path: Path, folders: Sequence[Path]) -> ModelAnalysis:
    """Find torso, legs and feet in a published model."""
    try:
        spec = read_model(path)
        for body in spec.bodies:
            if body.mass < 0.0:
                raise ModelError(
                    f"{path}: the mass of {body.name!r} must be positive, got "
                    f"{body.mass:g} kg"
                )
        roots = list(spec.worldbody.bodies)
        if not roots:
            raise ModelError(f"{path} has no body")
        torso = max(roots, key=lambda body: len(body.find_all("body"))).name
        couplings = [
            (each.name1, each.name2) for each in scaled_couplings(spec)
        ]
        missing = strip(spec, torso, path, list(folders))
        model = spec.compile()
    except ValueError as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(f"{path} cannot be compiled: {error}") from error
    for i in range(model.njnt):
        if model.jnt_type[i] in JOINT_TYPES and not model.joint(i).name:
            body = model.body(int(model.jnt_bodyid[i])).name
            raise ModelError(f"{path}: the joint of {body!r} must have a name")
    data, turn, legs = _legs(model, path)
    leg_joints = {*legs[0].joints, *legs[1].joints}
    for name in sorted(leg_joints):
        low, high = model.joint(name).range
        if not low <= high < low + WIDEST:
            raise ModelError(
                f"{path}: the upper limit of {name!r} must be above the lower "
                f"one, both in rad, got {low:g} to {high:g}"
            )
    for name, leader in couplings:
        if name in leg_joints and leader in leg_joints:
            raise ModelError(
                f"leg joint {name!r} of {path} must follow {leader!r} with "
                "polycoef 0 1 0 0 0: inverse kinematics supports no other "
                "coupling"
            )
    return ModelAnalysis(path, model, data, torso, legs, tuple(missing), turn)


def _legs(
    model: mujoco.MjModel, path: Path
) -> tuple[mujoco.MjData, Quaternion, tuple[DetectedLeg, DetectedLeg]]:
    """Find the legs in the orientation in which the robot faces forward."""
    first_error: ModelError | None = None
    for quarters in (0, 2, 1, 3):
        half = 0.25 * np.pi * quarters
        turn = (float(np.cos(half)), 0.0, 0.0, float(np.sin(half)))
        data = mujoco.MjData(model)
        data.qpos[:7] = (0.0, 0.0, 0.0, *turn)
        mujoco.mj_forward(model, data)
        try:
            legs = find_legs(model, data, path)
        except NoLegsError as error:
            first_error = first_error or error
            continue
        except ModelError as error:  # more specific than missing legs
            if first_error is None or isinstance(first_error, NoLegsError):
                first_error = error
            continue
        if sum(forward_score(model, leg) for leg in legs) >= 0.0:
            return data, turn, legs
        first_error = first_error or ModelError(
            f"{path}: toes and knees do not tell which way the robot faces"
        )
    assert first_error is not None
    raise first_error


def forward_score(model: mujoco.MjModel, leg: DetectedLeg) -> float:
    """Score the evidence that a leg faces forward; negative for backward.

    Some feet are longer behind the ankle and some knees bend backward, but
    no published robot is known to have both.
    """
    back, front, *_ = leg.outline
    low, high = leg.signs[1] * model.joint(leg.pitches[1]).range
    bends = round(low + high, 3) / max(abs(high - low), 0.1)
    toes = (front + back) / (front - back)
    if leg.is_guessed or abs(toes) < LEAST_ASYMMETRY:
        toes = 0.0
    return float(toes + KNEE_WEIGHT * bends)
