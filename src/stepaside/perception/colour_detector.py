"""Find a robot by the colour of its trim, in a colour image."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from .camera_model import CameraModel
from .images import ColourImage, Pixels

Mask = NDArray[np.uint8]
HUES = 180  # of OpenCV's circle
SMALLEST = 1.5  # pixels of a patch of trim, at 160 columns
PATCHES = 2  # of trim that make a robot, at least
ACROSS, DOWN = 2.5, 6.0  # gaps between patches, of the smaller one
SQUARE = 0.85  # share of its box that a round patch does not fill
LARGE = 2.5  # area of what is no trim, of the median patch
TALLEST = 0.6  # patch, of the height of all trim
WIDEST = 2.1  # all trim, of its height
ROOM = 0.1  # below the lowest trim, of its height, if it is the lowest
FULLEST = 0.5  # trim, of the box around all of it
FAINT = 0.55  # saturation of ears as narrow as a pixel, of that of trim
HEAD = 0.3  # height of the ears above the shoulders, of the trim's below


@dataclass(frozen=True, slots=True)
class Appearance:
    """How a robot looks to those who know it.

    Attributes:
        hue: Hue of its trim on OpenCV's circle of 180.
        width: How far hues stray from it.
        saturation: Least saturation of trim, of 255.
        value: Least brightness of trim, of 255.
        top: Height of the upper end of all trim, in [m].
        bottom: Height of the lower end, in [m].
    """

    hue: int
    width: int
    saturation: int
    value: int
    top: float = 0.54
    bottom: float = 0.06


RED = Appearance(hue=0, width=9, saturation=110, value=45)
BLUE = Appearance(hue=108, width=8, saturation=125, value=45)


@dataclass(frozen=True, slots=True)
class ColourDetection:
    """A robot in an image; columns and rows from its upper left corner.

    Attributes:
        column: Of its vertical axis.
        top: Row of the upper end of its trim.
        bottom: Row of the lower end.
        left: Column of the left end.
        right: Column of the right end.
        confidence: From 0 to 1: how much of its usual trim is there.
        cut_above: Whether it reaches beyond the upper edge of the image.
        cut_below: Whether it reaches beyond the lower edge.
        cut_aside: Whether it reaches beyond the left or right edge.
    """

    column: float
    top: float
    bottom: float
    left: float
    right: float
    confidence: float
    cut_above: bool
    cut_below: bool
    cut_aside: bool


class ColourDetector:
    """Finds one appearance: patches of trim, grouped and checked.

    Trim is many small patches on a white body; a box of the same colour is
    one large one. What is grouped must look like the former.
    """

    def __init__(self, appearance: Appearance) -> None:
        """Look for an appearance."""
        self.appearance = appearance

    def detect(self, image: ColourImage) -> ColourDetection | None:
        """Find the robot; the largest, if several look alike."""
        mask = self.mask(image.pixels)
        _, _, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
        least = max(3.0, SMALLEST * (image.camera.width / 160.0) ** 2)
        boxes = np.column_stack(
            [
                stats[1:, 0],
                stats[1:, 1],
                stats[1:, 0] + stats[1:, 2],
                stats[1:, 1] + stats[1:, 3],
                stats[1:, 4],
            ]
        )
        boxes = boxes[boxes[:, 4] >= least]
        best: ColourDetection | None = None
        for group in _groups(boxes):
            found = _judge(group, image.camera)
            if found is not None and (
                best is None
                or found.bottom - found.top > best.bottom - best.top
            ):
                best = found
        if best is None:
            return None
        return _with_ears(best, self.mask(image.pixels, FAINT), least)

    def mask(self, pixels: Pixels, share: float = 1.0) -> Mask:
        """Mark the pixels whose colour is that of the trim: 255, else 0.

        Args:
            pixels: Image. Shape (height, width, 3).
            share: Of the saturation that trim has, which is enough.
        """
        look = self.appearance
        hsv = cv2.cvtColor(cv2.blur(pixels, (3, 3)), cv2.COLOR_RGB2HSV)
        low, high = look.hue - look.width, look.hue + look.width
        least = round(share * look.saturation), look.value
        if low < 0:
            mask = cv2.inRange(hsv, (0, *least), (high, 255, 255))
            rest = cv2.inRange(hsv, (low + HUES, *least), (HUES, 255, 255))
            mask = cv2.bitwise_or(mask, rest)
        else:
            mask = cv2.inRange(hsv, (low, *least), (high, 255, 255))
        return np.asarray(mask, dtype=np.uint8)


def _groups(boxes: NDArray[np.int32]) -> list[NDArray[np.int32]]:
    """Patches that belong together: near each other for their size."""
    if len(boxes) == 0:
        return []
    left, top, right, bottom = boxes[:, :4].T
    size = np.maximum(right - left, bottom - top)
    across = np.maximum(left[:, None] - right, left - right[:, None])
    down = np.maximum(top[:, None] - bottom, top - bottom[:, None])
    smaller = np.minimum(size[:, None], size)
    near = (across <= ACROSS * smaller) & (down <= DOWN * smaller)
    groups, left_over = [], set(range(len(boxes)))
    while left_over:
        reached = {left_over.pop()}
        front = set(reached)
        while front:
            index = front.pop()
            new = {j for j in left_over if near[index, j]}
            left_over -= new
            reached |= new
            front |= new
        groups.append(boxes[sorted(reached)])
    return groups


def _judge(
    group: NDArray[np.int32], camera: CameraModel
) -> ColourDetection | None:
    """A group as a robot, or None if no robot looks so."""
    sizes = group[:, 2:4] - group[:, :2]
    areas = group[:, 4]
    # Trim is round: what is square and large is a thing beside the robot.
    square = areas > SQUARE * sizes.prod(axis=1)
    group = group[~(square & (areas > LARGE * np.median(areas)))]
    while True:
        if len(group) < PATCHES:
            return None
        left, top = group[:, :2].min(axis=0).tolist()
        right, bottom = group[:, 2:4].max(axis=0).tolist()
        height = bottom - top
        tall = group[:, 3] - group[:, 1]
        if len(group) == 2 and _is_profile(group):
            break
        if len(group) > 2 and tall.max() <= TALLEST * height:
            break
        group = np.delete(group, int(np.argmax(tall)), axis=0)
    # So near the edge, trim may be missing below.
    edge = camera.height - 1 - ROOM * height
    cut_above, cut_below = top <= 1, bottom >= edge
    cut_aside = left <= 1 or right >= camera.width - 1
    if right - left > WIDEST * height and not (cut_above or cut_below):
        return None
    fill = float(group[:, 4].sum()) / (height * (right - left))
    if fill > FULLEST:
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


def _with_ears(
    found: ColourDetection, faint: Mask, least: float
) -> ColourDetection:
    """Lift the upper end to ears that are too narrow to be sure of.

    Args:
        found: A robot.
        faint: Pixels that may be of its trim.
        least: Pixels of a patch.
    """
    height = found.bottom - found.top
    stats = cv2.connectedComponentsWithStats(faint, connectivity=8)[2][1:]
    left, top, width, tall, area = stats.T
    ears = (area >= least) & (left >= found.left)
    ears &= left + width <= found.right
    ears &= (top < found.top) & (top >= found.top - HEAD * height)
    ears &= (top + tall <= found.top + 1) & (tall < HEAD * height)
    number = int(ears.sum())
    if number == 0 or found.cut_above:
        return found
    highest = float(top[ears].min())
    return replace(
        found,
        top=highest,
        confidence=min(1.0, found.confidence + number / 8.0),
        cut_above=highest <= 1,
    )


def _is_profile(pair: NDArray[np.int32]) -> bool:
    """Whether two patches are ear and shoulder of a robot from its side."""
    upper, lower = pair[np.argsort(pair[:, 1])]
    broad = max(upper[2] - upper[0], lower[2] - lower[0])
    middle = 0.5 * abs(int(upper[0] + upper[2] - lower[0] - lower[2]))
    gap = lower[1] - upper[3]
    sizes = pair[:, 2:4] - pair[:, :2]
    square = (pair[:, 4] > SQUARE * sizes.prod(axis=1)).any()
    alike = pair[:, 4].max() < 4.0 * pair[:, 4].min()
    return bool(
        not square and alike and middle < 0.6 * broad and 0 <= gap < broad
    )


LOOKS = {"pursuer": BLUE, "evader": RED}  # by who looks
