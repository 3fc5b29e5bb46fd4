"""A map of the floor that grows with every depth image."""

import numpy as np
from numpy.typing import NDArray

from ..poses import Array
from ..rooms import Polygon
from ..rooms.covering import cover
from ..sensing.images import DepthImage

CELL = 0.05  # side of a cell, in [m]
HALF = 6.0  # from the start to the edge of the map, in [m]
SIDE = round(2.0 * HALF / CELL)
LOW, HIGH = 0.07, 0.7  # of what a body runs into, in [m]
LEVEL = 0.5  # below which a ray shows that the floor is free, in [m]
SELF = 0.22  # what is nearer to the own axis is the robot itself, in [m]
OTHER = 0.32  # what is nearer to the other player belongs to it, in [m]
SHORT = 0.1  # by which a ray ends before what it struck, in [m]
FIRST = 0.3  # of a ray that counts, from the own axis, in [m]
STRUCK, PASSED = 1.0, -0.35  # evidence of a ray
LEAST, MOST = -2.0, 5.0  # of the evidence of a cell
TAKEN = 1.5  # evidence from which a cell is taken: two images
TIGHT = 1.2  # cover of unseen floor, which must leave the seen free
NEARBY = 1.2  # within which unseen floor can count, in [m]


class FloorMap:
    """Which cells of the floor are taken, free or unseen, in odometry.

    Each image adds evidence where its rays strike something as high as a
    body, and takes some away where they pass: so what has moved is cleared
    when its place is seen again. The place of the other player, who moves
    all the time, is left out.

    Attributes:
        version: Counts the changes.
    """

    def __init__(self) -> None:
        """Know nothing yet."""
        self._evidence = np.zeros((SIDE, SIDE))
        self._seen = np.zeros((SIDE, SIDE), dtype=np.bool_)
        self.version = 0

    def take(
        self,
        image: DepthImage,
        place: Array,
        axes: Array,
        own: tuple[float, float],
        other: tuple[float, float] | None,
    ) -> None:
        """Take an image in.

        Args:
            image: The image.
            place: Place of the camera in odometry, in [m]. Shape (3,).
            axes: Its axes (forward, left, up) as columns. Shape (3, 3).
            own: Own axis in odometry, in [m].
            other: Other player in odometry, if it is seen, in [m].
        """
        depths = image.depths.astype(np.float64)
        points = place + depths[..., None] * (image.camera.rays() @ axes.T)
        there = (depths > 0.0) & (depths < 0.97 * image.far)
        level = points[..., 2]
        slack = LOW + 0.01 * depths
        struck = there & (level > slack) & (level < HIGH)
        flat = points[..., :2] - np.array(own)
        away = np.hypot(flat[..., 0], flat[..., 1])
        struck &= away > SELF
        theirs = np.zeros_like(struck)
        if other is not None:
            apart = points[..., :2] - np.array(other)
            theirs = np.hypot(apart[..., 0], apart[..., 1]) < OTHER
        self._pass(flat, away, there & (level < LEVEL), struck, own)
        cells = self._cells(points[struck & ~theirs][:, :2])
        counts = np.zeros((SIDE, SIDE), dtype=np.int64)
        np.add.at(counts, (cells[:, 0], cells[:, 1]), 1)
        hit = counts > 1  # one pixel alone may be noise
        self._evidence[hit] += STRUCK
        self._seen |= hit
        np.clip(self._evidence, LEAST, MOST, out=self._evidence)
        self.version += 1

    def _pass(
        self,
        flat: Array,
        away: Array,
        low: NDArray[np.bool_],
        struck: NDArray[np.bool_],
        own: tuple[float, float],
    ) -> None:
        """Take evidence away along the rays of each column."""
        far = np.where(low, away, 0.0)
        row = far.argmax(axis=0)
        columns = np.arange(far.shape[1])
        reach = far[row, columns]
        first = np.where(struck, away, np.inf).min(axis=0) - SHORT
        reach = np.minimum(reach, first)
        good = reach > FIRST
        if not good.any():
            return
        ahead = flat[row, columns][good] / far[row, columns][good][:, None]
        shares = np.arange(FIRST, float(reach[good].max()), CELL)
        inside = shares[None, :] < reach[good][:, None]
        points: Array = (
            np.array(own) + shares[None, :, None] * ahead[:, None, :]
        )
        cells = self._cells(points[inside])
        passed = np.zeros((SIDE, SIDE), dtype=np.bool_)
        passed[cells[:, 0], cells[:, 1]] = True
        self._evidence[passed] += PASSED
        self._seen |= passed

    def taken(self) -> tuple[Polygon, ...]:
        """What stands there, as far as it was seen, in odometry."""
        return cover(_centres(self._evidence > TAKEN), CELL)

    def unseen(self, place: tuple[float, float]) -> tuple[Polygon, ...]:
        """Floor near a place that nobody has seen yet, in odometry.

        Args:
            place: Own axis, in [m]; what it stands on is seen.
        """
        hidden = ~self._seen & (self._evidence <= TAKEN)
        centres = _centres(hidden)
        away = np.hypot(*(centres - place).T)
        return cover(centres[(away < NEARBY) & (away > FIRST)], CELL, TIGHT)

    @staticmethod
    def _cells(points: Array) -> NDArray[np.int64]:
        """Cells of points that lie on the map. Shape (n, 2)."""
        cells = np.floor((points + HALF) / CELL).astype(np.int64)
        inside = np.all((cells >= 0) & (cells < SIDE), axis=1)
        found: NDArray[np.int64] = cells[inside]
        return found


def _centres(chosen: NDArray[np.bool_]) -> Array:
    """Middles of cells, in [m]. Shape (n, 2)."""
    cells = np.argwhere(chosen).astype(np.float64)
    centres: Array = (cells + 0.5) * CELL - HALF
    return centres
