"""What the floor looks like, and what stands on it close by."""

from typing import NamedTuple

import cv2
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ..core.poses import Array
from .images import ColourImage, Pixels

BITS = 4  # of each colour that count
LEVELS = 2**BITS
ENOUGH = 4000  # pixels of floor that must have been seen
RARE = 0.01  # share of the pixels below which a colour is not the floor's
BEGIN, END = 0.25, 1.2  # of the floor that is looked at, from the axis [m]
LEAST = 20  # pixels of what stands there, at 80 columns
STRADDLE = 0.45  # between the feet of one person, at most, in [m]
FRONT = 0.02  # share of a thing's pixels nearer than where it begins


class FloorContact(NamedTuple):
    """Where something stands on the floor.

    Attributes:
        x: Middle of its nearer edge in odometry, in [m].
        y: Likewise.
        distance: From the own axis, in [m].
    """

    x: float
    y: float
    distance: float


class FloorColours:
    """Colours that the floor was seen to have."""

    def __init__(self, rare: float = RARE) -> None:
        """Know no floor.

        Args:
            rare: Share of the pixels below which a colour is not the
                floor's, but of what stood before it.
        """
        self._rare = rare
        self._counts = np.zeros((LEVELS,) * 3, dtype=np.int64)

    @property
    def known(self) -> bool:
        """Whether enough of the floor was seen."""
        return bool(self._counts.sum() >= ENOUGH)

    def learn(self, pixels: Pixels, floor: NDArray[np.bool_]) -> None:
        """Take pixels of the floor in.

        Args:
            pixels: An image. Shape (height, width, 3).
            floor: Which of them show floor. Shape (height, width).
        """
        coarse = pixels[floor] >> (8 - BITS)
        np.add.at(self._counts, tuple(coarse.T), 1)

    def strange(self, pixels: Pixels) -> NDArray[np.bool_]:
        """Which pixels look like no floor. Shape (height, width)."""
        least = self._rare * max(1, int(self._counts.sum()))
        floor = np.asarray(self._counts >= least)
        # A little lighter or darker is floor as well.
        near = sliding_window_view(np.pad(floor, 1), (3, 3, 3))
        like = np.asarray(near.any(axis=(3, 4, 5)))
        coarse = pixels >> (8 - BITS)
        found: NDArray[np.bool_] = ~like[tuple(np.moveaxis(coarse, 2, 0))]
        return found


def floor_points(image: ColourImage, place: Array, axes: Array) -> Array:
    """Where the pixels of an image meet the floor; infinite above it.

    Args:
        image: The image.
        place: Place of the camera in odometry, in [m]. Shape (3,).
        axes: Its axes (forward, left, up) as columns. Shape (3, 3).

    Returns:
        Places on the floor, in [m]. Shape (height, width, 2).
    """
    rays = image.camera.rays() @ axes.T
    down = -rays[..., 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.where(down > 1e-3, place[2] / down, np.inf)
        points = place[:2] + reach[..., None] * rays[..., :2]
    met: Array = np.where((down > 1e-3)[..., None], points, np.inf)
    return met


def find_footings(
    image: ColourImage,
    colours: FloorColours,
    place: Array,
    axes: Array,
    own: tuple[float, float],
) -> tuple[FloorContact, ...]:
    """Find what stands on the floor close by, by where its image begins.

    What has not the colours of the floor stands on it where it is seen
    lowest. Feet that are beside each other are of one person, who stands
    midway between them.

    Args:
        image: Of a camera that looks down.
        colours: Of the floor; unless it is known, nothing is found.
        place: Place of the camera in odometry, in [m]. Shape (3,).
        axes: Its axes as columns. Shape (3, 3).
        own: Own axis in odometry, in [m].

    Returns:
        The nearest first.
    """
    if not colours.known:
        return ()
    points = floor_points(image, place, axes)
    away = np.hypot(points[..., 0] - own[0], points[..., 1] - own[1])
    seen = (away > BEGIN) & (away < END) & colours.strange(image.pixels)
    block = np.ones((3, 3), np.uint8)
    dark = cv2.morphologyEx(seen.astype(np.uint8), cv2.MORPH_OPEN, block)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(dark)
    least = LEAST * (image.camera.width / 80.0) ** 2
    found = []
    for label in range(1, count):
        if stats[label, cv2.CC_STAT_AREA] < least:
            continue
        part = labels == label
        begin = float(np.quantile(away[part], FRONT))
        edge = part & (away < begin + 0.05)
        x, y = points[edge].mean(axis=0).tolist()
        found.append(FloorContact(x, y, begin))
    return _together(sorted(found, key=lambda footing: footing.distance))


def _together(feet: list[FloorContact]) -> tuple[FloorContact, ...]:
    """Take two feet beside each other for one person's."""
    rest, found = list(feet), []
    while rest:
        foot = rest.pop(0)
        for other in rest:
            if np.hypot(foot.x - other.x, foot.y - other.y) < STRADDLE:
                rest.remove(other)
                foot = FloorContact(
                    0.5 * (foot.x + other.x),
                    0.5 * (foot.y + other.y),
                    0.5 * (foot.distance + other.distance),
                )
                break
        found.append(foot)
    return tuple(found)
