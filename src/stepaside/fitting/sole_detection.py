"""Detection of the soles in a published model.

In the zero posture of a model its feet need not be level. The sole is the
largest flat side of the convex hull of a foot that faces downward; the foot
frame is level with it.
"""

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
    """Find the sole of a foot.

    ``hip``: Position of the hip, in [m]. Shape (3,). ``ankle``: Position of
    the ankle, in [m]. Shape (3,).
    """
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
