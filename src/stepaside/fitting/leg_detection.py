"""Detection of the legs in a published model, and of their soles.

In the zero posture its feet need not be level. The sole is the largest flat
side of the convex hull of a foot that faces downward.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ..core.errors import ModelError
from ..core.poses import Array
from ..robots.geom_points import geom_points_in_world

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


class DetectedSole(NamedTuple):
    """Sole of a foot in the zero posture."""

    axes: Array  # forward, left, up in the torso frame, as columns (3, 3)
    height: float  # height of the ankle over the sole [m]
    # edges from the ankle [m]: back, front, right, left
    outline: tuple[float, float, float, float]
    # whether height and outline are a guess, because the foot has no geoms
    is_guessed: bool = False


def sole_of(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    hip: Array,
    ankle: Array,
) -> DetectedSole:
    """Find the sole of a foot, with hip and ankle in [m]."""
    points = foot_points(model, data, body)
    if len(points) == 1:
        length = float(hip[2] - ankle[2])
        height, back, front, right, left = (x * length for x in GUESS)
        return DetectedSole(
            np.eye(3), height, (back, front, right, left), True
        )
    axes = np.eye(3)
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
    _check(model.body(body).name, (back, front, right, left), length)
    height = float(level_ankle[2]) - low
    return DetectedSole(axes, height, (back, front, right, left))


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


def _check(name: str, edges: tuple[float, ...], length: float) -> None:
    """Check that a sole has a plausible size and is under its ankle."""
    back, front, right, left = edges
    violation = check_size(edges, length)
    if not violation and not (back < 0.0 < front and right < 0.0 < left):
        got = ", ".join(f"{edge:.3f}" for edge in edges)
        violation = f"must be under its ankle, got edges {got} [m] from it"
    if violation:
        raise ModelError(
            f"the sole of {name!r} {violation}: its geoms have no flat side "
            "that the robot could stand on"
        )


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
    ends = [
        _End(
            body,
            float(foot_points(model, data, body)[:, 2].min()),
            float(data.xpos[body, 1]),
        )
        for body in _ends(model)
    ]
    feet = [
        min((e for e in ends if side * e.y > 0.0), key=lambda e: e.low)
        for side in (1.0, -1.0)
        if any(side * e.y > 0.0 for e in ends)
    ]
    if len(feet) < 2:
        raise NoLegsError(
            f"{path} does not have two legs: {_sides(data, ends)}"
        )
    near, far = (_chain(model, end.body) for end in feet)
    shared = set(near) & set(far)
    left, right = (
        _leg(model, data, end.body, [j for j in chain if j not in shared], at)
        for end, chain, at in zip(
            feet, (near, far), ("left", "right"), strict=True
        )
    )
    return left, right


class _End(NamedTuple):
    """Body at the end of a chain, its lowest point and its side, in [m]."""

    body: int
    low: float
    y: float


def _sides(data: mujoco.MjData, ends: list[_End]) -> str:
    if not ends:
        return (
            "no body below its torso has a hinge or a slide; the torso must "
            "be the root body with the most descendants"
        )
    below = np.abs(data.xpos[[end.body for end in ends]].mean(axis=0))
    if below.argmax() != 2:
        return (
            f"it stands along the {'xy'[below.argmax()]} axis of its torso, "
            "whose z axis must point up"
        )
    left = sum(end.y > 0.0 for end in ends)
    right = sum(end.y < 0.0 for end in ends)
    return (
        f"each side must have a joint chain that ends there, got {left} to "
        f"the left and {right} to the right of the torso origin; the z axis "
        "of the torso must point up, and its x or y axis forward"
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
    sole = sole_of(model, data, body, hip, ankle)
    return DetectedLeg(
        tuple(model.joint(j).name for j in chain),
        tuple(model.joint(j).name for j in pitches),
        tuple(float(np.sign(data.xaxis[j, 1])) for j in pitches),
        name,
        hip,
        ankle,
        float(ankle[2]) - sole.height,
        sole.outline,
        sole.is_guessed,
        sole.axes,
        data.xanchor[pitches].copy(),
    )
