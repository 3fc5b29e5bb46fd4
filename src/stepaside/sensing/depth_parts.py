"""Parts of a depth image that hang together."""

import cv2
import numpy as np
from numpy.typing import NDArray

from ..poses import Array

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
