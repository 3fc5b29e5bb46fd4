"""Floor in an image beyond the colours that are known: what is one with it."""

import cv2
import numpy as np
from numpy.typing import NDArray

from .images import Pixels

EVEN = 7  # steps of a colour between pixels of one surface, below this
KNOWN = 0.15  # share of a surface that must have the floor's colours
BROAD = 30  # pixels of the least surface
SQUARE = np.ones((3, 3), np.uint8)


def grow_floor(pixels: Pixels, known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which pixels show floor: those that are even with what is known to.

    The same floor is lighter or darker elsewhere, as light falls on it, but
    it changes by little from pixel to pixel, and by more where something
    else begins. Each surface without such an edge is floor or not as a
    whole. Lines between two surfaces of floor, as of tiles, are floor too.

    Args:
        pixels: An image. Shape (height, width, 3).
        known: Which have colours that floor was seen to have. Shape
            (height, width).

    Returns:
        Which show floor, the known ones included. Shape (height, width).
    """
    even = (_edges(pixels) < EVEN).astype(np.uint8)
    count, surfaces = cv2.connectedComponents(even, connectivity=4)
    size = np.bincount(surfaces.ravel(), minlength=count)
    sure = np.bincount(surfaces[known], minlength=count)
    is_floor = (size >= BROAD) & (sure >= KNOWN * size)
    is_floor[0] = False  # edges
    grown = (known | is_floor[surfaces]).astype(np.uint8)
    closed = cv2.morphologyEx(
        grown, cv2.MORPH_CLOSE, SQUARE, borderType=cv2.BORDER_REPLICATE
    )
    found: NDArray[np.bool_] = closed.astype(np.bool_)
    return found


def _edges(pixels: Pixels) -> NDArray[np.int16]:
    """Greatest change of a colour to the next pixels of a soft image."""
    soft = cv2.GaussianBlur(pixels, (3, 3), 0).astype(np.int16)
    found = np.zeros(soft.shape[:2], np.int16)
    for image, edges in ((soft, found), (soft.swapaxes(0, 1), found.T)):
        step = np.abs(np.diff(image, axis=0)).max(axis=2)
        np.maximum(edges[1:], step, out=edges[1:])
        np.maximum(edges[:-1], step, out=edges[:-1])
    return found
