"""The floor close by, by the lower camera of the head: what a map lacks."""

import numpy as np

from ..core.poses import Array
from .floor_colours import FloorColours, floor_points
from .floor_growing import grow_floor
from .floor_map import FloorMap
from .images import ColourImage

EVERY = 2  # of this many colour images one is of the lower camera
SPARSE = 2  # of this many rows and columns of an image one counts
LEARNT = 0.6, 2.5  # distances of floor whose colours are learnt, in [m]
SHOWN = 0.15, 0.9  # of floor that is looked at, from the own axis, in [m]
APART = 0.4  # from floor that is learnt to the other player, in [m]
# Share of the pixels below which a colour is not the floor's: who is not yet
# known to stand there is learnt with it.
RARE = 0.05


class NearFloorMapper:
    """Shows a map the floor that its depth camera is too near to measure.

    Within the near limit of that camera a thing hides the floor before it,
    too. The lower camera sees this floor. What floor looks like is learnt
    from images of the upper camera, where the depth camera saw that nothing
    stands; close by floor is lighter, and what is even with floor counts as
    floor. It adds nothing that stands there, and takes nothing away: what
    looks like floor was seen, and is free unless rays struck something.
    """

    def __init__(self, floor: FloorMap) -> None:
        """Know no colours of the floor of a map."""
        self._floor = floor
        self._colours = FloorColours(RARE)
        self._images = 0

    def wanted(self) -> bool:
        """Whether the next colour image is to be of the lower camera."""
        self._images += 1
        return self._colours.known and self._images % EVERY == 0

    def learn(
        self,
        image: ColourImage,
        place: Array,
        axes: Array,
        own: tuple[float, float],
        other: tuple[float, float] | None,
    ) -> None:
        """Learn what the floor looks like, from an upper image.

        Args:
            image: The image.
            place: Place of the camera in odometry, in [m]. Shape (3,).
            axes: Its axes as columns. Shape (3, 3).
            own: Own axis in odometry, in [m].
            other: Other player in odometry, if it is seen, in [m].
        """
        points = floor_points(image, place, axes)[::SPARSE, ::SPARSE]
        away = np.hypot(points[..., 0] - own[0], points[..., 1] - own[1])
        chosen = (away > LEARNT[0]) & (away < LEARNT[1])
        if other is not None:
            # Whoever stands there hides the floor behind as well.
            gap = np.hypot(
                points[..., 0] - other[0], points[..., 1] - other[1]
            )
            beyond = away > np.hypot(other[0] - own[0], other[1] - own[1])
            chosen &= (gap > APART) & ~beyond
        chosen[chosen] = self._floor.is_free(points[chosen])
        self._colours.learn(image.pixels[::SPARSE, ::SPARSE], chosen)

    def show(
        self,
        image: ColourImage,
        place: Array,
        axes: Array,
        own: tuple[float, float],
    ) -> None:
        """Tell the map what floor a lower image shows.

        Args:
            image: The image.
            place: Place of the camera in odometry, in [m]. Shape (3,).
            axes: Its axes as columns. Shape (3, 3).
            own: Own axis in odometry, in [m].
        """
        points = floor_points(image, place, axes)[::SPARSE, ::SPARSE]
        away = np.hypot(points[..., 0] - own[0], points[..., 1] - own[1])
        near = (away > SHOWN[0]) & (away < SHOWN[1])
        pixels = image.pixels[::SPARSE, ::SPARSE]
        bare = grow_floor(pixels, ~self._colours.strange(pixels))
        self._floor.show(points[near & bare], points[near & ~bare])
