"""Colour histogram of the floor, and detection of feet on it close by."""

from collections.abc import Iterable
from math import hypot
from typing import NamedTuple

import cv2
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ..core.poses import Array
from .camera_pose import CameraPose
from .images import ColourImage, Pixels

BITS = 4  # of each colour channel in the histogram
LEVELS = 2**BITS
MIN_PIXELS = 4000  # of floor before the histogram is used
# Fraction of the pixels below which a colour is not the floor's.
MIN_FRACTION = 0.01
# Distances from the own axis at which feet are detected, in [m].
NEAR = 0.25
FAR = 1.2
MIN_AREA = 20  # of a foot at 80 columns, in [pixels]
MAX_FOOT_GAP = 0.45  # between the feet of one person, in [m]
FRONT = 0.02  # quantile of the distances that is the front edge of a foot


class FloorContact(NamedTuple):
    """Point at which an object stands on the floor.

    Attributes:
        x_in_odometry: Middle of its near edge, in [m].
        y_in_odometry: Middle of its near edge, in [m].
        distance: Distance from the own axis, in [m].
    """

    x_in_odometry: float
    y_in_odometry: float
    distance: float


class FloorColours:
    """Histogram of the colours of the floor.

    Attributes:
        counts: Pixels of the floor by levels of red, green and blue. Shape
            (LEVELS, LEVELS, LEVELS).
    """

    def __init__(self, min_fraction: float = MIN_FRACTION) -> None:
        """Start with an empty histogram.

        Args:
            min_fraction: Fraction of the pixels below which a colour is not
                the floor's, but that of an object in front of it.
        """
        self._min_fraction = min_fraction
        self.counts = np.zeros((LEVELS,) * 3, dtype=np.int64)

    @property
    def known(self) -> bool:
        """Whether the histogram holds enough pixels."""
        return bool(self.counts.sum() >= MIN_PIXELS)

    def learn(self, pixels: Pixels, floor: NDArray[np.bool_]) -> None:
        """Add pixels of the floor.

        Args:
            pixels: Image. Shape (height, width, 3).
            floor: Mask of the floor. Shape (height, width).
        """
        coarse = pixels[floor] >> (8 - BITS)
        np.add.at(self.counts, tuple(coarse.T), 1)

    def is_not_floor(self, pixels: Pixels) -> NDArray[np.bool_]:
        """Return the mask of other colours than the floor's.

        Args:
            pixels: Image. Shape (height, width, 3).

        Returns:
            Mask. Shape (height, width).
        """
        least = self._min_fraction * max(1, int(self.counts.sum()))
        floor = np.asarray(self.counts >= least)
        # Neighbouring levels are floor too, at other brightness.
        near = sliding_window_view(np.pad(floor, 1), (3, 3, 3))
        is_floor = np.asarray(near.any(axis=(3, 4, 5)))
        coarse = pixels >> (8 - BITS)
        found: NDArray[np.bool_] = ~is_floor[tuple(np.moveaxis(coarse, 2, 0))]
        return found


def floor_points(image: ColourImage, camera: CameraPose) -> Array:
    """Return the floor points of the pixels; infinite above the horizon.

    Args:
        image: The image.
        camera: Pose of the camera at its exposure.

    Returns:
        Points in odometry, in [m]. Shape (height, width, 2).
    """
    rays, eye = camera.rays(image.camera), camera.position_in_odometry
    down = -rays[..., 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.where(down > 1e-3, eye[2] / down, np.inf)
        points = eye[:2] + reach[..., None] * rays[..., :2]
    points_or_inf: Array = np.where((down > 1e-3)[..., None], points, np.inf)
    return points_or_inf


def floor_in_view(
    points_in_odometry: Array,
    camera: CameraPose,
    reach: tuple[float, float],
    objects_in_odometry: Iterable[tuple[float, float]],
    *,
    margin: float,
    depth: float = 0.0,
) -> NDArray[np.bool_]:
    """Return the mask of floor that no object covers or hides.

    Args:
        points_in_odometry: Floor points of pixels, in [m]. Shape
            (height, width, 2).
        camera: Pose of the camera.
        reach: Least and greatest distance of the floor, in [m].
        objects_in_odometry: Positions of objects on the floor, in [m].
        margin: Distance from each object to the floor, in [m].
        depth: Distance before each object from which on it hides the floor,
            in [m].

    Returns:
        Mask. Shape (height, width).
    """
    distances = camera.distances(points_in_odometry)
    least, greatest = reach
    floor = (distances > least) & (distances < greatest)
    own_x, own_y = camera.position_torso_in_odometry
    for x, y in objects_in_odometry:
        apart = np.hypot(
            points_in_odometry[..., 0] - x, points_in_odometry[..., 1] - y
        )
        hidden = distances > hypot(x - own_x, y - own_y) - depth
        floor &= (apart > margin) & ~hidden
    return floor


def detect_feet(
    image: ColourImage,
    camera: CameraPose,
    colours: FloorColours,
) -> tuple[FloorContact, ...]:
    """Detect feet on the floor close by, by their near edges.

    A component of other colours than the floor's touches the floor at its
    lowest pixels. Two feet beside each other belong to one person, whose
    position is midway between them.

    Args:
        image: Image of the bottom camera.
        camera: Pose of the camera at its exposure.
        colours: Colours of the floor; without enough of them nothing is
            detected.

    Returns:
        Floor contacts, nearest first.
    """
    if not colours.known:
        return ()
    points = floor_points(image, camera)
    distances = camera.distances(points)
    candidates = (
        (distances > NEAR)
        & (distances < FAR)
        & colours.is_not_floor(image.pixels)
    )
    block = np.ones((3, 3), np.uint8)
    cleaned = cv2.morphologyEx(
        candidates.astype(np.uint8), cv2.MORPH_OPEN, block
    )
    count, labels, stats, _ = cv2.connectedComponentsWithStats(cleaned)
    least = MIN_AREA * (image.camera.width / 80.0) ** 2
    found = []
    for label in range(1, count):
        if stats[label, cv2.CC_STAT_AREA] < least:
            continue
        part = labels == label
        front = float(np.quantile(distances[part], FRONT))
        edge = part & (distances < front + 0.05)
        x, y = points[edge].mean(axis=0).tolist()
        found.append(FloorContact(x, y, front))
    return _join_feet(sorted(found, key=lambda footing: footing.distance))


def _join_feet(feet: list[FloorContact]) -> tuple[FloorContact, ...]:
    """Join two feet beside each other."""
    remaining, found = list(feet), []
    while remaining:
        foot = remaining.pop(0)
        for other in remaining:
            if (
                np.hypot(
                    foot.x_in_odometry - other.x_in_odometry,
                    foot.y_in_odometry - other.y_in_odometry,
                )
                < MAX_FOOT_GAP
            ):
                remaining.remove(other)
                foot = FloorContact(
                    0.5 * (foot.x_in_odometry + other.x_in_odometry),
                    0.5 * (foot.y_in_odometry + other.y_in_odometry),
                    0.5 * (foot.distance + other.distance),
                )
                break
        found.append(foot)
    return tuple(found)
