"""Mapping of the floor close by with the bottom camera."""

import cv2
import numpy as np
from numpy.typing import NDArray

from .camera_pose import CameraPose
from .floor_colours import FloorColours, floor_in_view, floor_points
from .floor_map import FloorMap
from .images import ColourImage, Pixels

EVERY = 2  # one in so many colour images is from the bottom camera
STRIDE = 2  # between the rows and columns of an image that are used
LEARNT = 0.6, 2.5  # distances of floor whose colours are learnt, in [m]
MAPPED = 0.15, 0.9  # distances of floor that is mapped, in [m]
MARGIN = 0.4  # from floor whose colours are learnt to the opponent, in [m]
# Fraction of the pixels below which a colour is not the floor's: before the
# opponent is tracked, its colours are learnt with the floor's.
MIN_FRACTION = 0.05
MAX_STEP = 7  # of a colour channel between pixels of one surface, of 255
MIN_KNOWN = 0.15  # fraction of a surface with the floor's colours
MIN_AREA = 30  # of a surface, in [pixels]
SQUARE = np.ones((3, 3), np.uint8)


class NearFloorMapper:
    """Mapper of free floor nearer than the range of the depth camera.

    Within the near limit of the depth camera an obstacle also hides the
    floor in front of it, which the bottom camera shows. The colours of the
    floor are learnt from images of the top camera, where the depth camera
    has measured free floor. Lighting changes them close by, so regions are
    grown. Cells become known by this, but never occupied or cleared: depth
    alone decides that.

    Attributes:
        colours: Colours of the floor learnt so far.
    """

    def __init__(
        self, floor: FloorMap, colours: FloorColours | None = None
    ) -> None:
        """Start with colours of the floor; without them, none are known."""
        self._floor = floor
        self.colours = colours or FloorColours(MIN_FRACTION)
        self._images = 0

    def wanted(self) -> bool:
        """Return whether the next image should be from the bottom camera."""
        self._images += 1
        return self.colours.known and self._images % EVERY == 0

    def learn(
        self,
        image: ColourImage,
        camera: CameraPose,
        position_opponent_in_odometry: tuple[float, float] | None,
    ) -> None:
        """Learn the colours of the floor from an image of the top camera.

        Args:
            image: The image.
            camera: Pose of the camera at its exposure.
            position_opponent_in_odometry: Position of the opponent, in [m];
                None if it is not tracked.
        """
        points = floor_points(image, camera)[::STRIDE, ::STRIDE]
        opponent = position_opponent_in_odometry
        chosen = floor_in_view(
            points,
            camera,
            LEARNT,
            () if opponent is None else (opponent,),
            margin=MARGIN,
        )
        chosen[chosen] = self._floor.is_free(points[chosen])
        self.colours.learn(image.pixels[::STRIDE, ::STRIDE], chosen)

    def show(self, image: ColourImage, camera: CameraPose) -> None:
        """Mark floor in an image of the bottom camera as known in the map.

        Args:
            image: The image.
            camera: Pose of the camera at its exposure.
        """
        points = floor_points(image, camera)[::STRIDE, ::STRIDE]
        distances = camera.distances(points)
        near = (distances > MAPPED[0]) & (distances < MAPPED[1])
        pixels = image.pixels[::STRIDE, ::STRIDE]
        bare = grow_floor(pixels, ~self.colours.is_not_floor(pixels))
        self._floor.show(points[near & bare], points[near & ~bare])


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
