"""Detection of a robot in a colour image by the colour of its trim."""

from dataclasses import dataclass, replace
from math import ceil

import cv2
import numpy as np
from numpy.typing import NDArray

from .camera_model import CameraModel
from .images import ColourImage, Pixels

Mask = NDArray[np.uint8]
HUES = 180  # range of OpenCV's hue
MIN_AREA = 1.5  # of a patch of trim at 160 columns, in [pixels]
MIN_PATCHES = 2  # patches of a robot
# Largest gaps between patches of one robot, in sizes of the smaller patch.
MAX_GAP_ACROSS = 2.5
MAX_GAP_DOWN = 6.0
# A patch that fills more of its bounding box is square; trim is round.
SQUARE_FILL = 0.85
LARGE_AREA = 2.5  # a square patch above so many median areas is no trim
MAX_PATCH_HEIGHT = 0.6  # as a fraction of the height of all trim
MAX_WIDTH = 2.1  # of all trim, as a fraction of its height
# Margin below the lowest trim, as a fraction of the height, within which the
# image edge may cut lower trim off.
EDGE_MARGIN = 0.1
MAX_FILL = 0.5  # fraction of the bounding box of all trim that trim fills
# Saturation of one-pixel wide ears, as a fraction of that of trim.
EAR_SATURATION = 0.55
# Height of the ears above the shoulders, as a fraction of the trim below.
EAR_HEIGHT = 0.3


@dataclass(frozen=True, slots=True)
class Appearance:
    """Colour and height of a robot's trim."""

    hue: int  # hue, 0 to 180 as in OpenCV
    width: int  # tolerance of the hue
    saturation: int  # minimum saturation, of 255
    value: int  # minimum brightness, of 255
    top: float = 0.54  # height of the upper end of all trim [m]
    bottom: float = 0.06  # height of the lower end [m]


RED = Appearance(hue=0, width=9, saturation=110, value=45)
BLUE = Appearance(hue=108, width=8, saturation=125, value=45)


@dataclass(frozen=True, slots=True)
class ColourDetection:
    """Robot in an image; columns and rows from the upper left corner."""

    column: float  # column of its vertical axis
    top: float  # row of the upper end of its trim
    bottom: float  # row of the lower end
    left: float  # column of the left end
    right: float  # column of the right end
    confidence: float  # fraction of its usual number of patches, 0 to 1
    cut_above: bool  # whether the upper image edge cuts it
    cut_below: bool  # whether the lower image edge cuts it
    cut_aside: bool  # whether the left or right image edge cuts it


class ColourDetector:
    """Detector of robots with one appearance.

    Patches of the trim colour are grouped, and groups are checked: trim is
    many small patches on a white body, while a box of the same colour is one
    large patch.
    """

    def __init__(self, appearance: Appearance) -> None:
        self.appearance = appearance

    def detect(self, image: ColourImage) -> ColourDetection | None:
        """Detect the tallest robot, if any."""
        hsv = smoothed_hsv(image.pixels)
        stats = _patches(self.mask(hsv))
        least = max(3.0, MIN_AREA * (image.camera.width / 160.0) ** 2)
        stats[:, 2:4] += stats[:, :2]  # right and lower ends
        boxes = stats[stats[:, 4] >= least]
        fitting = [
            found
            for group in _groups(boxes)
            if (found := check_group(group, image.camera)) is not None
        ]
        if not fitting:
            return None
        tallest = min(fitting, key=lambda found: found.top - found.bottom)
        return self._with_ears(tallest, hsv, least)

    def mask(self, hsv: Pixels, saturation_factor: float = 1.0) -> Mask:
        """Return 255 where a `smoothed_hsv` image has the trim's colour."""
        appearance = self.appearance
        low = appearance.hue - appearance.width
        high = appearance.hue + appearance.width
        faintest = round(saturation_factor * appearance.saturation)
        least = faintest, appearance.value
        mask = cv2.inRange(hsv, (max(low, 0), *least), (high, 255, 255))
        if low < 0:
            rest = cv2.inRange(hsv, (low + HUES, *least), (HUES, 255, 255))
            mask = cv2.bitwise_or(mask, rest)
        return np.asarray(mask, dtype=np.uint8)

    def _with_ears(
        self, found: ColourDetection, hsv: Pixels, least: float
    ) -> ColourDetection:
        """Extend a detection to ears: narrow, less saturated patches."""
        if found.cut_above:
            return found
        height = found.bottom - found.top
        highest = found.top - EAR_HEIGHT * height
        # A margin of one pixel: a patch that reaches into it is no ear.
        first_row = max(0, ceil(highest) - 1)
        first_column = max(0, int(found.left) - 1)
        area = hsv[
            first_row : int(found.top) + 2,
            first_column : int(found.right) + 1,
        ]
        faint = self.mask(area, EAR_SATURATION)
        left, top, width, tall, size = _patches(faint).T
        left, top = left + first_column, top + first_row
        ears = (size >= least) & (left >= found.left)
        ears &= left + width <= found.right
        ears &= (top < found.top) & (top >= highest)
        ears &= (top + tall <= found.top + 1) & (tall < EAR_HEIGHT * height)
        number = int(ears.sum())
        if number == 0:
            return found
        upper = float(top[ears].min())
        return replace(
            found,
            top=upper,
            confidence=min(1.0, found.confidence + number / 8.0),
            cut_above=upper <= 1,
        )


def smoothed_hsv(pixels: Pixels) -> Pixels:
    """Return hue, saturation and value. Shape (height, width, 3)."""
    hsv = cv2.cvtColor(cv2.blur(pixels, (3, 3)), cv2.COLOR_RGB2HSV)
    return np.asarray(hsv, dtype=np.uint8)


def _patches(mask: Mask) -> NDArray[np.int32]:
    """Return left, top, width, height and area of patches. Shape (n, 5)."""
    x, y, width, height = cv2.boundingRect(mask)
    if width == 0:
        return np.zeros((0, 5), np.int32)
    # OpenCV numbers patches by blocks of two by two pixels.
    x, y, right, bottom = x & ~1, y & ~1, x + width, y + height
    stats = cv2.connectedComponentsWithStats(
        mask[y:bottom, x:right], connectivity=8
    )[2][1:]
    stats[:, :2] += (x, y)
    return np.asarray(stats, dtype=np.int32)


def _groups(boxes: NDArray[np.int32]) -> list[NDArray[np.int32]]:
    """Group patches that are near each other for their size."""
    if len(boxes) == 0:
        return []
    left, top, right, bottom = boxes[:, :4].T
    size = np.maximum(right - left, bottom - top)
    across = np.maximum(left[:, None] - right, left - right[:, None])
    down = np.maximum(top[:, None] - bottom, top - bottom[:, None])
    smaller = np.minimum(size[:, None], size)
    near = (across <= MAX_GAP_ACROSS * smaller) & (
        down <= MAX_GAP_DOWN * smaller
    )
    group = np.arange(len(boxes))  # of each patch: its first member
    before = group - 1
    while not np.array_equal(group, before):
        before, group = group, np.where(near, group, len(boxes)).min(axis=1)
    return [boxes[group == first] for first in np.unique(group)]


def check_group(
    group: NDArray[np.int32], camera: CameraModel
) -> ColourDetection | None:
    """Return the detection of a group; None if it does not fit a robot."""
    sizes = group[:, 2:4] - group[:, :2]
    areas = group[:, 4]
    # Trim is round: a large square patch is an object beside the robot.
    square = areas > SQUARE_FILL * sizes.prod(axis=1)
    group = group[~(square & (areas > LARGE_AREA * np.median(areas)))]
    while True:
        if len(group) < MIN_PATCHES:
            return None
        left, top = group[:, :2].min(axis=0).tolist()
        right, bottom = group[:, 2:4].max(axis=0).tolist()
        height = bottom - top
        tall = group[:, 3] - group[:, 1]
        if len(group) == 2 and _is_profile(group):
            break
        if len(group) > 2 and tall.max() <= MAX_PATCH_HEIGHT * height:
            break
        group = np.delete(group, int(np.argmax(tall)), axis=0)
    # Near the lower edge, trim may be cut off.
    edge = camera.height - 1 - EDGE_MARGIN * height
    cut_above, cut_below = top <= 1, bottom >= edge
    cut_aside = left <= 1 or right >= camera.width - 1
    if right - left > MAX_WIDTH * height and not (cut_above or cut_below):
        return None
    fill = float(group[:, 4].sum()) / (height * (right - left))
    if fill > MAX_FILL:
        return None
    return ColourDetection(
        0.5 * (left + right),
        top,
        bottom,
        left,
        right,
        min(1.0, len(group) / 8.0),
        cut_above,
        cut_below,
        cut_aside,
    )


def _is_profile(pair: NDArray[np.int32]) -> bool:
    """Return whether two patches are ear and shoulder, seen from the side."""
    upper, lower = pair[np.argsort(pair[:, 1])]
    broad = max(upper[2] - upper[0], lower[2] - lower[0])
    middle = 0.5 * abs(int(upper[0] + upper[2] - lower[0] - lower[2]))
    gap = lower[1] - upper[3]
    sizes = pair[:, 2:4] - pair[:, :2]
    square = (pair[:, 4] > SQUARE_FILL * sizes.prod(axis=1)).any()
    alike = pair[:, 4].max() < 4.0 * pair[:, 4].min()
    return bool(
        not square and alike and middle < 0.6 * broad and 0 <= gap < broad
    )


TRIMS = {"pursuer": RED, "evader": BLUE}  # of robots, by their role
LOOKS = {"pursuer": BLUE, "evader": RED}  # opponent's, by own role
