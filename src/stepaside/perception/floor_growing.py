"""Region growing of the floor in an image beyond its known colours."""

import cv2
import numpy as np
from numpy.typing import NDArray

from .images import Pixels

MAX_STEP = 7  # of a colour channel between pixels of one surface, of 255
MIN_KNOWN = 0.15  # fraction of a surface with the floor's colours
MIN_AREA = 30  # of a surface, in [pixels]
SQUARE = np.ones((3, 3), np.uint8)


def grow_floor(pixels: Pixels, known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Grow the mask of known floor over surfaces without edges.

    Lighting changes the colour of a floor gradually, while an object begins
    at an edge. A surface without edges is floor as a whole if enough of it
    is known to be. Thin lines between two such surfaces, as between tiles,
    are floor too.

    Args:
        pixels: Image. Shape (height, width, 3).
        known: Pixels with a known colour of the floor. Shape
            (height, width).

    Returns:
        Mask of the floor, which contains ``known``. Shape (height, width).
    """
    smooth = (_edges(pixels) < MAX_STEP).astype(np.uint8)
    count, surfaces = cv2.connectedComponents(smooth, connectivity=4)
    size = np.bincount(surfaces.ravel(), minlength=count)
    known_area = np.bincount(surfaces[known], minlength=count)
    is_floor = (size >= MIN_AREA) & (known_area >= MIN_KNOWN * size)
    is_floor[0] = False  # edges
    grown = (known | is_floor[surfaces]).astype(np.uint8)
    closed = cv2.morphologyEx(
        grown, cv2.MORPH_CLOSE, SQUARE, borderType=cv2.BORDER_REPLICATE
    )
    found: NDArray[np.bool_] = closed.astype(np.bool_)
    return found


def _edges(pixels: Pixels) -> NDArray[np.int16]:
    """Return the largest colour step to a neighbour in the blurred image."""
    blurred = cv2.GaussianBlur(pixels, (3, 3), 0).astype(np.int16)
    found = np.zeros(blurred.shape[:2], np.int16)
    for image, edges in ((blurred, found), (blurred.swapaxes(0, 1), found.T)):
        step = np.abs(np.diff(image, axis=0)).max(axis=2)
        np.maximum(edges[1:], step, out=edges[1:])
        np.maximum(edges[:-1], step, out=edges[:-1])
    return found
