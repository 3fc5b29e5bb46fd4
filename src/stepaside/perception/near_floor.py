"""Mapping of the floor close by with the bottom camera."""

import numpy as np

from ..core.poses import Array
from .floor_colours import FloorColours, floor_points
from .floor_growing import grow_floor
from .floor_map import FloorMap
from .images import ColourImage

EVERY = 2  # one in so many colour images is from the bottom camera
STRIDE = 2  # between the rows and columns of an image that are used
LEARNT = 0.6, 2.5  # distances of floor whose colours are learnt, in [m]
MAPPED = 0.15, 0.9  # distances of floor that is mapped, in [m]
MARGIN = 0.4  # from floor whose colours are learnt to the opponent, in [m]
# Fraction of the pixels below which a colour is not the floor's: before the
# opponent is tracked, its colours are learnt with the floor's.
MIN_FRACTION = 0.05


class NearFloorMapper:
    """Mapper of free floor nearer than the range of the depth camera.

    Within the near limit of the depth camera an obstacle also hides the
    floor in front of it, which the bottom camera shows. The colours of the
    floor are learnt from images of the top camera, where the depth camera
    has measured free floor. Lighting changes them close by, so regions are
    grown. Cells become known by this, but never occupied or cleared: depth
    alone decides that.
    """

    def __init__(self, floor: FloorMap) -> None:
        """Start without colours of the floor."""
        self._floor = floor
        self._colours = FloorColours(MIN_FRACTION)
        self._images = 0

    def wanted(self) -> bool:
        """Return whether the next image should be from the bottom camera."""
        self._images += 1
        return self._colours.known and self._images % EVERY == 0

    def learn(
        self,
        image: ColourImage,
        position_camera_in_odometry: Array,
        axes_camera_in_odometry: Array,
        position_own_in_odometry: tuple[float, float],
        position_opponent_in_odometry: tuple[float, float] | None,
    ) -> None:
        """Learn the colours of the floor from an image of the top camera.

        Args:
            image: The image.
            position_camera_in_odometry: Position of the camera, in [m].
                Shape (3,).
            axes_camera_in_odometry: Its axes (forward, left, up) as columns.
                Shape (3, 3).
            position_own_in_odometry: Position of the robot, in [m].
            position_opponent_in_odometry: Position of the opponent, in [m];
                None if it is not tracked.
        """
        points = floor_points(
            image, position_camera_in_odometry, axes_camera_in_odometry
        )[::STRIDE, ::STRIDE]
        distances = np.hypot(
            points[..., 0] - position_own_in_odometry[0],
            points[..., 1] - position_own_in_odometry[1],
        )
        chosen = (distances > LEARNT[0]) & (distances < LEARNT[1])
        if position_opponent_in_odometry is not None:
            # The opponent also hides the floor behind it.
            gap = np.hypot(
                points[..., 0] - position_opponent_in_odometry[0],
                points[..., 1] - position_opponent_in_odometry[1],
            )
            beyond = distances > np.hypot(
                position_opponent_in_odometry[0] - position_own_in_odometry[0],
                position_opponent_in_odometry[1] - position_own_in_odometry[1],
            )
            chosen &= (gap > MARGIN) & ~beyond
        chosen[chosen] = self._floor.is_free(points[chosen])
        self._colours.learn(image.pixels[::STRIDE, ::STRIDE], chosen)

    def show(
        self,
        image: ColourImage,
        position_camera_in_odometry: Array,
        axes_camera_in_odometry: Array,
        position_own_in_odometry: tuple[float, float],
    ) -> None:
        """Mark floor in an image of the bottom camera as known in the map.

        Args:
            image: The image.
            position_camera_in_odometry: Position of the camera, in [m].
                Shape (3,).
            axes_camera_in_odometry: Its axes (forward, left, up) as columns.
                Shape (3, 3).
            position_own_in_odometry: Position of the robot, in [m].
        """
        points = floor_points(
            image, position_camera_in_odometry, axes_camera_in_odometry
        )[::STRIDE, ::STRIDE]
        distances = np.hypot(
            points[..., 0] - position_own_in_odometry[0],
            points[..., 1] - position_own_in_odometry[1],
        )
        near = (distances > MAPPED[0]) & (distances < MAPPED[1])
        pixels = image.pixels[::STRIDE, ::STRIDE]
        bare = grow_floor(pixels, ~self._colours.is_not_floor(pixels))
        self._floor.show(points[near & bare], points[near & ~bare])
