"""Find whatever stands in the way, in a depth image."""

from dataclasses import dataclass
from math import atan2
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from .images import DepthImage

JUMP = 0.25  # of depth between pixels of one thing, at most, in [m]
SMALLEST = 14  # pixels of a thing, at 80 columns
FREE, TAKEN, NEW = 0, 1, 2  # of a pixel while parts are filled


def parts_of(
    solid: NDArray[np.bool_], depths: Array
) -> list[NDArray[np.bool_]]:
    """Take an image apart where its depth jumps.

    A hole of two pixels, where nothing came back, does not take a thing
    apart: it counts as deep as the nearest thing beside it, so that it ties
    nothing to what stands behind.

    Args:
        solid: Pixels that count. Shape (height, width).
        depths: Depth along the axis of the camera, in [m]. Same shape.

    Returns:
        The pixels of each part. Shapes (height, width).
    """
    block = np.ones((3, 3), np.uint8)
    closed = cv2.morphologyEx(solid.astype(np.uint8), cv2.MORPH_CLOSE, block)
    filled = np.where(solid, depths, np.inf).astype(np.float32)
    filled = np.where(solid, filled, cv2.erode(filled, block))
    filled[np.isinf(filled)] = 0.0
    # OpenCV fills what is free, within a frame of one pixel.
    state = np.full((solid.shape[0] + 2, solid.shape[1] + 2), TAKEN, np.uint8)
    state[1:-1, 1:-1][closed > 0] = FREE
    least = SMALLEST * (solid.shape[1] / 80.0) ** 2
    how = 8 | cv2.FLOODFILL_MASK_ONLY | NEW << 8
    parts = []
    for row, column in np.argwhere(closed > 0).tolist():
        if state[row + 1, column + 1] != FREE:
            continue
        count, *_ = cv2.floodFill(
            filled, state, (column, row), 0.0, JUMP, JUMP, how
        )
        new = state == NEW
        state[new] = TAKEN
        if count >= least:
            parts.append(new[1:-1, 1:-1] & solid)
    return parts


FLOOR = 0.07  # what is lower belongs to the floor, in [m]
CEILING = 2.2  # what is higher is in nobody's way, in [m]
SELF = 0.22  # what is nearer to the own axis is the robot itself, in [m]
BROADEST = 1.1  # what is broader is a wall, in [m]
LOWEST = 0.15  # height of what is in the way, in [m]
TRUSTED = 0.95  # share of the far limit up to which a thing is whole
PIECE = 2.0  # distance from which a thing has to be in view as a whole, [m]
TRUNCATED = 0.12  # beyond the near limit: part of it may be nearer, in [m]
THIN = 0.25  # of a leg, at most, in [m]
STRADDLE = 0.45  # between the legs of one person, at most, in [m]
GAP = 0.25  # between parts of one near thing, legs for one, in [rad]
BLIND = 24  # pixels without return that something near must hide


class DepthComponent(NamedTuple):
    """A part of something near.

    Attributes:
        low: Its right end from the camera's axis, in [rad].
        high: Its left end, in [rad].
        nearest: The nearest that was measured of it, in [m].
        whole: Whether neither side is cut by the edge of the image.
    """

    low: float
    high: float
    nearest: float | None
    whole: bool


@dataclass(frozen=True, slots=True)
class DetectedObstacle:
    """Something that is neither floor nor the robot itself.

    Attributes:
        x: Its estimated axis in odometry, in [m].
        y: Likewise.
        nearest: Distance of its nearest part from the camera, in [m].
        bearing: Direction of its middle from the camera, in odometry, in
            [rad].
        azimuth: The same from the camera's axis, positive leftward.
        width: Breadth, in [m].
        height: Height of its upper end above the floor, in [m].
        whole: Whether neither side is cut by the edge of the image.
        rises: Whether it is cut by the upper edge.
    """

    x: float
    y: float
    nearest: float
    bearing: float
    azimuth: float
    width: float
    height: float
    whole: bool
    rises: bool = False


@dataclass(frozen=True, slots=True)
class Shadow:
    """Something too near to be measured, that hides the floor.

    Attributes:
        bearing: Direction of its middle from the camera, in odometry, in
            [rad].
        azimuth: The same from the camera's axis, positive leftward.
        width: How broad it looks, in [rad].
        nearest: Distance of the nearest part that was measured all the
            same, in [m]; None if there is none.
        whole: Whether neither side is cut by the edge of the image.
    """

    bearing: float
    azimuth: float
    width: float
    nearest: float | None = None
    whole: bool = True


@dataclass(frozen=True, slots=True)
class DepthScene:
    """What a depth image shows.

    Attributes:
        obstacles: The nearest first.
        shadows: The broadest first.
    """

    obstacles: tuple[DetectedObstacle, ...]
    shadows: tuple[Shadow, ...]


def detect_obstacles(
    image: DepthImage, place: Array, axes: Array, own: tuple[float, float]
) -> DepthScene:
    """Remove floor and self, and cluster the rest.

    Args:
        image: Depth image.
        place: Place of the camera in odometry, at its exposure, in [m].
            Shape (3,).
        axes: Its axes (forward, left, up) as columns, with the measured
            tilt of the body. Shape (3, 3).
        own: Own axis in odometry, in [m].
    """
    rays = image.camera.rays() @ axes.T
    depths = image.depths.astype(np.float64)
    points = place + depths[..., None] * rays
    there = depths > 0.0
    level = points[..., 2]
    # A tilt that is off lifts the far floor.
    slack = FLOOR + 0.01 * depths
    solid = there & (level > slack) & (level < CEILING)
    away = np.hypot(points[..., 0] - own[0], points[..., 1] - own[1])
    solid &= away > SELF
    found = [
        _measure(points[part], part, place, axes)
        for part in parts_of(solid, depths)
    ]
    things = [
        thing
        for thing in found
        if thing.width < BROADEST
        and thing.height > LOWEST
        and thing.nearest < TRUSTED * image.far
        # A piece of a wall, cut off by the edge of the image.
        and (thing.whole or thing.nearest < PIECE)
    ]
    things = join_legs(sorted(things, key=lambda thing: thing.nearest))
    dark = _shadows(image, depths, rays, place, axes)
    whole: list[DetectedObstacle] = []
    near = list(dark)
    for thing in things:
        half = 0.5 * thing.width / thing.nearest
        low, high = thing.azimuth - half, thing.azimuth + half
        # What hides the floor without an echo may be a nearer part of it.
        hidden = any(p.low - GAP < high and low - GAP < p.high for p in dark)
        if thing.nearest < image.near + TRUNCATED and hidden:
            near.append(DepthComponent(low, high, thing.nearest, thing.whole))
        else:
            whole.append(thing)
    ahead = atan2(axes[1, 0], axes[0, 0])
    return DepthScene(tuple(whole), _join(near, ahead))


def _join(parts: list[DepthComponent], ahead: float) -> tuple[Shadow, ...]:
    """Join parts into near things, whose middle is that of their ends."""
    joined: list[DepthComponent] = []
    for part in sorted(parts, key=lambda part: part[:2]):
        if not joined or part.low >= joined[-1].high + GAP:
            joined.append(part)
            continue
        low, high, known, whole = joined[-1]
        told = [n for n in (known, part.nearest) if n is not None]
        joined[-1] = DepthComponent(
            low,
            max(part.high, high),
            min(told, default=None),
            whole and part.whole,
        )
    shadows = [
        Shadow(
            ahead + 0.5 * (low + high),
            0.5 * (low + high),
            high - low,
            nearest,
            whole,
        )
        for low, high, nearest, whole in joined
    ]
    return tuple(sorted(shadows, key=lambda shadow: -shadow.width))


def join_legs(things: list[DetectedObstacle]) -> list[DetectedObstacle]:
    """Take for one person two legs whose hips are above the view.

    Args:
        things: What was found, the nearest first.

    Returns:
        The same, where two thin ones beside each other, which both reach
        beyond the upper edge of the image, have become one.
    """
    left_over, joined = list(things), []
    while left_over:
        leg = left_over.pop(0)
        for other in left_over:
            apart = float(np.hypot(leg.x - other.x, leg.y - other.y))
            if _is_leg(leg) and _is_leg(other) and apart < STRADDLE:
                left_over.remove(other)
                leg = _astride(leg, other)
                break
        joined.append(leg)
    return joined


def _is_leg(thing: DetectedObstacle) -> bool:
    return thing.rises and thing.width < THIN


def _astride(
    leg: DetectedObstacle, other: DetectedObstacle
) -> DetectedObstacle:
    """The person midway between two legs."""
    ends = [
        thing.azimuth + side * 0.5 * thing.width / thing.nearest
        for thing in (leg, other)
        for side in (-1.0, 1.0)
    ]
    middle = 0.5 * (min(ends) + max(ends))
    return DetectedObstacle(
        0.5 * (leg.x + other.x),
        0.5 * (leg.y + other.y),
        leg.nearest,
        leg.bearing + middle - leg.azimuth,
        middle,
        leg.nearest * (max(ends) - min(ends)),
        max(leg.height, other.height),
        leg.whole and other.whole,
        True,
    )


def _measure(
    points: Array, part: NDArray[np.bool_], place: Array, axes: Array
) -> DetectedObstacle:
    dx, dy = points[:, 0] - place[0], points[:, 1] - place[1]
    ahead = atan2(axes[1, 0], axes[0, 0])
    azimuths = (np.arctan2(dy, dx) - ahead + np.pi) % (2.0 * np.pi) - np.pi
    distances = np.hypot(dx, dy)
    nearest = float(np.quantile(distances, 0.1))
    low, high = np.quantile(azimuths, (0.02, 0.98)).tolist()
    azimuth = 0.5 * (low + high)
    width = nearest * (high - low)
    columns = np.flatnonzero(part.any(axis=0))
    reach = nearest + min(max(0.5 * width, 0.11), 0.16)
    bearing = ahead + azimuth
    return DetectedObstacle(
        float(place[0] + reach * np.cos(bearing)),
        float(place[1] + reach * np.sin(bearing)),
        nearest,
        bearing,
        azimuth,
        width,
        float(points[:, 2].max()),
        bool(columns[0] > 0 and columns[-1] < part.shape[1] - 1),
        bool(part[:2].any()),
    )


def _shadows(
    image: DepthImage, depths: Array, rays: Array, place: Array, axes: Array
) -> list[DepthComponent]:
    """Where the floor should answer and does not: something too near."""
    down = -rays[..., 2]
    with np.errstate(divide="ignore"):
        floor = np.where(down > 1e-6, place[2] / down, np.inf)
    expected = (floor > 1.1 * image.near) & (floor < 0.85 * image.far)
    dark = (expected & (depths == 0.0)).astype(np.uint8)
    dark = np.asarray(
        cv2.morphologyEx(dark, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8)),
        dtype=np.uint8,
    )
    count, labels, stats, _ = cv2.connectedComponentsWithStats(
        dark, connectivity=8
    )
    least = BLIND * (depths.shape[1] / 80.0) ** 2
    shadows = []
    ahead = atan2(axes[1, 0], axes[0, 0])
    for label in range(1, count):
        if stats[label, cv2.CC_STAT_AREA] < least:
            continue
        directions = rays[labels == label]
        azimuths = np.arctan2(directions[:, 1], directions[:, 0]) - ahead
        azimuths = (azimuths + np.pi) % (2.0 * np.pi) - np.pi
        low, high = float(azimuths.min()), float(azimuths.max())
        left, wide = stats[label, [cv2.CC_STAT_LEFT, cv2.CC_STAT_WIDTH]]
        whole = bool(left > 0 and left + wide < depths.shape[1])
        shadows.append(DepthComponent(low, high, None, whole))
    return shadows
