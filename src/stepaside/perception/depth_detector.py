"""Detection of obstacles in a depth image."""

from dataclasses import dataclass
from math import dist
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array, wrap_angles
from ..robots.robot_tree import NAO_SIZE, OWN_MARGIN, BodySize
from .camera_model import CameraPose
from .images import DepthImage

MAX_STEP = 0.25  # of depth between pixels of one component, in [m]
MIN_AREA = 14  # of a component at 80 columns, in [pixels]
# States of a pixel during the flood fill.
UNFILLED = 0
DONE = 1
NEW = 2


def segment_depth(
    solid: NDArray[np.bool_], depths: Array
) -> list[NDArray[np.bool_]]:
    """Segment pixels at steps of the depth; return masks of components.

    A hole of up to two pixels is filled with the nearest depth beside it: it
    splits no component, and joins none to one behind.
    """
    block = np.ones((3, 3), np.uint8)
    closed = cv2.morphologyEx(solid.astype(np.uint8), cv2.MORPH_CLOSE, block)
    filled = np.where(solid, depths, np.inf).astype(np.float32)
    filled = np.where(solid, filled, cv2.erode(filled, block))
    filled[np.isinf(filled)] = 0.0
    # OpenCV fills pixels whose mask is zero; the mask has a border of one.
    state = np.full((solid.shape[0] + 2, solid.shape[1] + 2), DONE, np.uint8)
    state[1:-1, 1:-1][closed > 0] = UNFILLED
    least = MIN_AREA * (solid.shape[1] / 80.0) ** 2
    flags = 8 | cv2.FLOODFILL_MASK_ONLY | NEW << 8
    parts = []
    for row, column in np.argwhere(closed > 0).tolist():
        if state[row + 1, column + 1] != UNFILLED:
            continue
        count, *_ = cv2.floodFill(
            filled, state, (column, row), 0.0, MAX_STEP, MAX_STEP, flags
        )
        new = state == NEW
        state[new] = DONE
        if count >= least:
            parts.append(new[1:-1, 1:-1] & solid)
    return parts


FLOOR = 0.07  # points below belong to the floor, in [m]
CEILING = 2.2  # points above are no obstacle, in [m]
MAX_WIDTH = 1.1  # wider components are walls, in [m]
MIN_HEIGHT = 0.15  # of an obstacle, in [m]
TRUSTED = 0.95  # fraction of the far limit within which depth is complete
WHOLE_BEYOND = 2.0  # farther obstacles must not be cut by an edge, in [m]
TRUNCATED = 0.12  # beyond the near limit: part may be nearer, in [m]
TALL = 0.75  # height beyond which an obstacle may be a person, in [m]
# By which a tenth of a body is nearer than a quarter of it, as seen from
# ahead, in [m]; more is an arm, which is 0.1 m nearer from the side.
ROUNDNESS = 0.02
MAX_LEG_WIDTH = 0.25  # in [m]
MAX_LEG_GAP = 0.45  # between the legs of one person, in [m]
MAX_SHADOW_GAP = 0.25  # between parts of one near object, as legs, in [rad]
MIN_SHADOW_AREA = 24  # pixels without return, at 80 columns
# Sine of a ray's slope from which floor returns: depth cameras measure up to
# an incidence of about 83 degrees; the tilt may be wrong by 1.5 degrees.
MIN_SLOPE = 0.15


@dataclass(frozen=True, slots=True)
class DetectedObstacle:
    """Obstacle in a depth image, neither floor nor the robot itself."""

    x_in_odometry: float  # estimated x of its vertical axis [m]
    y_in_odometry: float  # estimated y of its vertical axis [m]
    nearest: float  # distance from the camera to its nearest part [m]
    # direction of its middle from the camera, in odometry [rad]
    bearing: float
    azimuth: float  # the same from the camera axis, positive leftward [rad]
    width: float  # [m]
    height: float  # height of its upper end above the floor [m]
    whole: bool  # whether the image edges cut neither side
    rises: bool = False  # whether the upper image edge cuts it

    @property
    def position(self) -> tuple[float, float]:
        """Position of its axis in odometry, in [m]."""
        return self.x_in_odometry, self.y_in_odometry


class Shadow(NamedTuple):
    """Object too near to be measured, which hides the floor."""

    low: float  # azimuth of its right end from the camera axis [rad]
    high: float  # azimuth of its left end [rad]
    # distance of the nearest part that was measured all the same [m]; None if
    # there is none
    nearest: float | None = None
    whole: bool = True  # whether the image edges cut neither side

    @property
    def azimuth(self) -> float:
        """Direction of its middle from the camera axis, in [rad]."""
        return 0.5 * (self.low + self.high)

    @property
    def width(self) -> float:
        """Angle that it spans, in [rad]."""
        return self.high - self.low


@dataclass(frozen=True, slots=True)
class DepthScene:
    """Obstacles and shadows of one depth image."""

    obstacles: tuple[DetectedObstacle, ...]  # obstacles, nearest first
    shadows: tuple[Shadow, ...]  # shadows, widest first


def detect_obstacles(
    image: DepthImage, camera: CameraPose, size: BodySize = NAO_SIZE
) -> DepthScene:
    """Detect obstacles: remove floor and own body, segment the rest."""
    rays = camera.rays(image.camera)
    no_return = _shadows(image, camera, rays)
    whole: list[DetectedObstacle] = []
    near = list(no_return)
    for obstacle in _obstacles(image, camera, rays, size):
        half = 0.5 * obstacle.width / obstacle.nearest
        low, high = obstacle.azimuth - half, obstacle.azimuth + half
        # Missing floor beside it may be a nearer part of the same object.
        hidden = any(
            p.low - MAX_SHADOW_GAP < high and low - MAX_SHADOW_GAP < p.high
            for p in no_return
        )
        if obstacle.nearest < image.near + TRUNCATED and hidden:
            near.append(Shadow(low, high, obstacle.nearest, obstacle.whole))
        else:
            whole.append(obstacle)
    return DepthScene(tuple(whole), _join_shadows(near))


def _obstacles(
    image: DepthImage, camera: CameraPose, rays: Array, size: BodySize
) -> list[DetectedObstacle]:
    """Return the obstacles of an image, nearest first."""
    depths = image.depths.astype(np.float64)
    points = camera.position_in_odometry + depths[..., None] * rays
    valid = depths > 0.0
    heights = points[..., 2]
    # An error of the tilt lifts the far floor.
    slack = FLOOR + 0.01 * depths
    solid = valid & (heights > slack) & (heights < CEILING)
    solid &= camera.distances(points) > size.radius + OWN_MARGIN
    measured = [
        _measure(points[part], part, camera)
        for part in segment_depth(solid, depths)
    ]
    obstacles = [
        obstacle
        for obstacle in measured
        if obstacle.width < MAX_WIDTH
        and obstacle.height > MIN_HEIGHT
        and obstacle.nearest < TRUSTED * image.far
        # An image edge may cut a piece off a wall.
        and (obstacle.whole or obstacle.nearest < WHOLE_BEYOND)
    ]
    return join_legs(sorted(obstacles, key=lambda obstacle: obstacle.nearest))


def _join_shadows(parts: list[Shadow]) -> tuple[Shadow, ...]:
    """Join shadows at small gaps."""
    joined: list[Shadow] = []
    for part in sorted(parts, key=lambda part: part[:2]):
        if not joined or part.low >= joined[-1].high + MAX_SHADOW_GAP:
            joined.append(part)
            continue
        low, high, known, whole = joined[-1]
        ranges = [n for n in (known, part.nearest) if n is not None]
        nearest, whole = min(ranges, default=None), whole and part.whole
        joined[-1] = Shadow(low, max(part.high, high), nearest, whole)
    return tuple(sorted(joined, key=lambda shadow: -shadow.width))


def join_legs(obstacles: list[DetectedObstacle]) -> list[DetectedObstacle]:
    """Join two narrow legs of a person whose hips are above the image."""
    remaining, joined = list(obstacles), []
    while remaining:
        leg = remaining.pop(0)
        for other in remaining:
            near = dist(leg.position, other.position) < MAX_LEG_GAP
            if near and _is_leg(leg) and _is_leg(other):
                remaining.remove(other)
                leg = _person_between(leg, other)
                break
        joined.append(leg)
    return joined


def _is_leg(obstacle: DetectedObstacle) -> bool:
    return obstacle.rises and obstacle.width < MAX_LEG_WIDTH


def _person_between(
    leg: DetectedObstacle, other: DetectedObstacle
) -> DetectedObstacle:
    """Return the person midway between two legs."""
    ends = [
        obstacle.azimuth + side * 0.5 * obstacle.width / obstacle.nearest
        for obstacle in (leg, other)
        for side in (-1.0, 1.0)
    ]
    middle = 0.5 * (min(ends) + max(ends))
    return DetectedObstacle(
        0.5 * (leg.x_in_odometry + other.x_in_odometry),
        0.5 * (leg.y_in_odometry + other.y_in_odometry),
        leg.nearest,
        leg.bearing + middle - leg.azimuth,
        middle,
        leg.nearest * (max(ends) - min(ends)),
        max(leg.height, other.height),
        leg.whole and other.whole,
        True,
    )


def _measure(
    points: Array, part: NDArray[np.bool_], camera: CameraPose
) -> DetectedObstacle:
    """Return the obstacle of a component, by points (n, 3) and pixels."""
    eye, heading = camera.position_in_odometry, camera.heading_in_odometry
    dx, dy = points[:, 0] - eye[0], points[:, 1] - eye[1]
    azimuths = wrap_angles(np.arctan2(dy, dx) - heading)
    distances = np.hypot(dx, dy)
    nearest = float(np.quantile(distances, 0.1))
    low, high = np.quantile(azimuths, (0.02, 0.98)).tolist()
    azimuth = 0.5 * (low + high)
    width = nearest * (high - low)
    columns = np.flatnonzero(part.any(axis=0))
    height = float(points[:, 2].max())
    front = nearest
    if height > TALL:
        front = max(front, float(np.quantile(distances, 0.25)) - ROUNDNESS)
    reach = front + min(max(0.5 * width, 0.11), 0.16)
    bearing = heading + azimuth
    return DetectedObstacle(
        float(eye[0] + reach * np.cos(bearing)),
        float(eye[1] + reach * np.sin(bearing)),
        nearest,
        bearing,
        azimuth,
        width,
        height,
        bool(columns[0] > 0 and columns[-1] < part.shape[1] - 1),
        bool(part[:2].any()),
    )


def _shadows(
    image: DepthImage, camera: CameraPose, rays: Array
) -> list[Shadow]:
    """Find floor that should return depth and does not."""
    depths, down = image.depths, -rays[..., 2]
    floor = camera.position_in_odometry[2] / np.maximum(down, 1e-9)
    expected = (floor > 1.1 * image.near) & (floor < 0.85 * image.far)
    expected &= down > MIN_SLOPE * np.linalg.norm(rays, axis=-1)
    no_return = (expected & (depths == 0.0)).astype(np.uint8)
    block = np.ones((3, 3), np.uint8)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(
        cv2.morphologyEx(no_return, cv2.MORPH_OPEN, block), connectivity=8
    )
    least = MIN_SHADOW_AREA * (depths.shape[1] / 80.0) ** 2
    shadows = []
    for label in range(1, count):
        if stats[label, cv2.CC_STAT_AREA] < least:
            continue
        directions = rays[labels == label]
        azimuths = wrap_angles(
            np.arctan2(directions[:, 1], directions[:, 0])
            - camera.heading_in_odometry
        )
        low, high = float(azimuths.min()), float(azimuths.max())
        left, wide = stats[label, [cv2.CC_STAT_LEFT, cv2.CC_STAT_WIDTH]]
        whole = bool(left > 0 and left + wide < depths.shape[1])
        shadows.append(Shadow(low, high, None, whole))
    return shadows
