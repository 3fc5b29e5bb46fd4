"""Soles of a published model: where its feet are flat, however they tilt.

In the zero posture of a model its feet need not be level. What a foot can
stand on is the largest flat side of its convex hull that looks downward; the
foot frame is level when that side is.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ..core.errors import ModelError
from ..core.poses import Array
from ..sim.geom_points import points_of

FLAT = 0.012  # of the leg's length: what of a foot counts as its sole
STEEP = np.cos(np.radians(40.0))  # of a side that the robot may stand on
ALIKE = np.cos(np.radians(2.0))  # of sides that count as one
TILTED = np.sin(
    np.radians(1.0)
)  # a foot that tilts by less is taken for level
TRIES = 4  # rounds in which a tilt is found: round geoms touch elsewhere
# Length and width of a sole by that of the leg: less carries no robot, and
# more is no foot.
LENGTHS = (0.1, 0.8)
WIDTHS = (0.03, 0.6)
# Height of an ankle over the sole and edges of the sole, as parts of a leg.
GUESS = (0.12, -0.12, 0.22, -0.09, 0.09)


class DetectedSole(NamedTuple):
    """What a foot stands on, in the zero posture.

    Attributes:
        axes: Axes forward, left and up of the foot that stands, as columns,
            in those of the torso. Shape (3, 3).
        height: Of the ankle over the sole, along the axis up, in [m].
        outline: Edges from the ankle, in [m]: back, front, right, left.
        is_guessed: Whether height and outline are a guess, for the foot has
            no geoms that say.
    """

    axes: Array
    height: float
    outline: tuple[float, float, float, float]
    is_guessed: bool = False


def sole_of(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body: int,
    hip: Array,
    ankle: Array,
) -> DetectedSole:
    """Find what a foot stands on.

    Args:
        model: The model.
        data: Its zero posture, with the torso level at the origin.
        body: Body of the foot.
        hip: Place of the hip, in [m]. Shape (3,).
        ankle: Place of the last joint, likewise.

    Raises:
        ModelError: If its geoms have no side that a robot can stand on.
    """
    points = foot_points(model, data, body)
    if len(points) == 1:
        length = float(hip[2] - ankle[2])
        height, back, front, right, left = (x * length for x in GUESS)
        return DetectedSole(
            np.eye(3), height, (back, front, right, left), True
        )
    axes = np.eye(3)
    for _ in range(TRIES):
        down = _downward(points)
        if down is None:
            break
        axes = _standing_on(axes @ down)
        points = foot_points(model, _turned(model, data, axes.T), body)
    where = axes.T @ ankle
    low = float(points[:, 2].min())
    length = float((axes.T @ hip)[2] - low)
    flat = points[points[:, 2] < low + FLAT * length] - where
    (back, right), (front, left) = (
        flat[:, :2].min(axis=0).tolist(),
        flat[:, :2].max(axis=0).tolist(),
    )
    _check(model.body(body).name, (back, front, right, left), length)
    height = float(where[2]) - low
    return DetectedSole(axes, height, (back, front, right, left))


def foot_points(
    model: mujoco.MjModel, data: mujoco.MjData, body: int
) -> Array:
    """Points on the surface of an end, those that collide if any do.

    Returns:
        Places, in [m], shape (n, 3); that of the body where it has none.
    """
    geoms = [
        geom
        for part in _rigid(model, body)
        for geom in range(
            model.body_geomadr[part],
            model.body_geomadr[part] + model.body_geomnum[part],
        )
    ]
    touching = [
        geom
        for geom in geoms
        if model.geom_contype[geom] or model.geom_conaffinity[geom]
    ]
    found = [points_of(model, data, geom) for geom in touching or geoms]
    found = [points for points in found if len(points)]
    if not found:
        return np.array([data.xpos[body]])
    return np.concatenate(found)


def check_size(edges: tuple[float, ...], length: float) -> str:
    """What is wrong with the size of a sole, in words; empty if nothing.

    Args:
        edges: Back, front, right and left one, in [m].
        length: Of the leg, in [m].
    """
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
    """Refuse a sole that no robot stands on.

    Raises:
        ModelError: If it is too small or large, or not under its ankle.
    """
    back, front, right, left = edges
    wrong = check_size(edges, length)
    if not wrong and not (back < 0.0 < front and right < 0.0 < left):
        got = ", ".join(f"{edge:.3f}" for edge in edges)
        wrong = f"must lie under its ankle, got edges {got} [m] from it"
    if wrong:
        raise ModelError(
            f"the sole of {name!r} {wrong}: its geoms have no flat side that "
            "the robot could stand on"
        )


def _downward(points: Array) -> Array | None:
    """Where the side looks that a foot can stand on; None if that is down.

    Returns:
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
    steep = -normals[:, 2] >= STEEP
    normals, areas = normals[steep], areas[steep]
    if not len(areas):
        return None
    best, down = 0.0, normals[0]
    for i in np.argsort(-areas)[:40]:
        area = float(areas[normals @ normals[i] > ALIKE].sum())
        if area > best * (1.0 + 1e-9):
            best, down = area, normals[i]
    is_level = np.hypot(down[0], down[1]) < TILTED
    return None if is_level else down


def _standing_on(down: Array) -> Array:
    """Axes of a foot that pitches and then rolls to look down so."""
    forward = np.cross((0.0, 1.0, 0.0), -down)
    forward /= np.linalg.norm(forward)
    return np.stack([forward, np.cross(-down, forward), -down], axis=1)


def _turned(
    model: mujoco.MjModel, data: mujoco.MjData, matrix: Array
) -> mujoco.MjData:
    """The same posture, all of it turned."""
    turned = mujoco.MjData(model)
    turned.qpos[:] = data.qpos
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, matrix.ravel())
    mujoco.mju_mulQuat(turned.qpos[3:7], turn, data.qpos[3:7].copy())
    mujoco.mj_kinematics(model, turned)
    return turned


def _rigid(model: mujoco.MjModel, body: int) -> list[int]:
    """A body and all that hangs on it."""
    found = [body]
    for other in range(body + 1, model.nbody):
        if int(model.body_parentid[other]) in found:
            found.append(other)
    return found
