"""A map of the floor that grows with every depth image."""

from math import inf

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ..arena import Polygon
from ..arena.polygon_cover import cover
from ..core.poses import Array, wrap_angles
from .images import DepthImage

CELL = 0.05  # side of a cell, in [m]
HALF = 6.0  # from the start to the edge of the map, in [m]
SIDE = round(2.0 * HALF / CELL)
LOW, HIGH = 0.07, 0.7  # of what a body runs into, in [m]
LEVEL = 0.5  # below which a ray shows that the floor is free, in [m]
SELF = 0.22  # what is nearer to the own axis is the robot itself, in [m]
OTHER = 0.32  # what is nearer to the other player belongs to it, in [m]
BLUR = 0.05  # by which the direction of a column may be off, in [rad]
SHORT = 0.1  # by which evidence ends before what a ray struck, in [m]
BRIEF = 0.03  # by which what a ray shows ends before that, in [m]
START = 0.35  # of floor that is free around a robot that begins, in [m]
STOOD = 0.06  # of floor that is free where the other player stands, in [m]
BODY = 0.2  # of what was struck of it before it was ever recognised, in [m]
FIRST = 0.3  # of a ray that counts, from the own axis, in [m]
STRUCK, PASSED = 1.0, -0.35  # evidence of a ray
LEAST, MOST = -2.0, 5.0  # of the evidence of a cell
TAKEN = 1.5  # evidence from which a cell is taken: two images
TIGHT = 1.2  # cover of unseen floor, which must leave the seen free
NEARBY = 1.2  # within which unseen floor can count, in [m]
WINDOW = round(NEARBY / CELL) + 2  # cells to the edge of what is near
SAME = 0.2  # of what was measured from what it belongs to, in [m]
SECTOR = np.pi / 8  # in which a polygon of unseen floor lies, in [rad]
FEW = 3  # pixels of floor that show a cell
MIXED = 0.25  # share of other pixels from which a cell is no floor
# Steps of a cell to all cells around one.
STENCIL = np.argwhere(np.ones((17, 17))) - 8

Cells = tuple[NDArray[np.int64], NDArray[np.int64]]


class FloorMap:
    """Which cells of the floor are taken, free or unseen, in odometry.

    Each image adds evidence where its rays strike something as high as a
    body, and takes some away where they pass: so what has moved is cleared
    when its place is seen again. The place of the other player, who moves
    all the time, is left out, and what was struck of it until it was
    recognised. A robot that begins has room to turn.

    What is nearer than a depth camera measures, or out of its view, stays
    unseen until a ray passes over it: a thing that hides the floor behind it
    keeps the floor in front of it unseen as well, unless another camera shows
    that floor.

    Attributes:
        version: Counts the changes.
    """

    def __init__(self) -> None:
        """Know nothing yet."""
        self._evidence = np.zeros((SIDE, SIDE))
        self._seen = np.zeros((SIDE, SIDE), dtype=np.bool_)
        self._recognised = False
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
        if not self.version:
            self._stand(own, START)
        struck = there & (level > slack) & (level < HIGH)
        flat = points[..., :2] - np.array(own)
        away = np.hypot(flat[..., 0], flat[..., 1])
        struck &= away > SELF
        theirs = np.zeros_like(struck)
        if other is not None:
            apart = points[..., :2] - np.array(other)
            theirs = np.hypot(apart[..., 0], apart[..., 1]) < OTHER
        low = there & (level < LEVEL)
        beside = round(BLUR * image.camera.focal_x)
        blocked = _beside(np.asarray(~low.any(axis=0)), beside)
        begin = np.where(blocked, image.near, FIRST)
        self._pass(flat, away, low, struck, own, begin)
        # One pixel alone may be noise.
        hit = self._counts(points[struck & ~theirs][:, :2]) > 1
        self._evidence[hit] += STRUCK
        self._seen |= hit
        if other is not None:
            self._stand(other, STOOD)
            if not self._recognised:
                # Later nothing it stands beside is to be forgotten.
                self._forget(other, BODY)
                self._recognised = True
        np.clip(self._evidence, LEAST, MOST, out=self._evidence)
        self.version += 1

    def _pass(
        self,
        flat: Array,
        away: Array,
        low: NDArray[np.bool_],
        struck: NDArray[np.bool_],
        own: tuple[float, float],
        begin: Array,
    ) -> None:
        """Take evidence away along the rays of each column.

        What is too near for any depth blocks all of a column. Where the head
        looked is known to a few degrees while it turns: columns beside such
        a one begin to tell something where depth does.
        """
        far = np.where(low, away, 0.0)
        row = far.argmax(axis=0)
        columns = np.arange(far.shape[1])
        reach = far[row, columns]
        first = np.where(struck, away, np.inf).min(axis=0)
        good = np.minimum(reach, first) > FIRST
        if not good.any():
            return
        ahead = flat[row, columns][good] / far[row, columns][good][:, None]
        reach, first, begin = reach[good], first[good], begin[good]
        shown = np.minimum(reach, first - BRIEF)
        self._seen |= self._along(own, ahead, begin, shown)
        passed = np.minimum(reach, first - SHORT)
        self._evidence[self._along(own, ahead, begin, passed)] += PASSED

    def _along(
        self,
        own: tuple[float, float],
        ahead: Array,
        begin: Array,
        reach: Array,
    ) -> NDArray[np.bool_]:
        """Cells along lines between two distances from the own axis."""
        shares = np.arange(FIRST, max(FIRST, float(reach.max())), CELL)
        inside = (shares >= begin[:, None]) & (shares < reach[:, None])
        points: Array = (
            np.array(own) + shares[None, :, None] * ahead[:, None, :]
        )
        cells = self._cells(points[inside])
        found = np.zeros((SIDE, SIDE), dtype=np.bool_)
        found[cells[:, 0], cells[:, 1]] = True
        return found

    def _stand(self, place: tuple[float, float], radius: float) -> None:
        """Free the floor on which somebody stands."""
        self._seen[self._forget(place, radius)] = True

    def _forget(self, place: tuple[float, float], radius: float) -> Cells:
        """Take evidence away around a place, and tell where."""
        cells = self._cells(np.array([place])) + STENCIL
        away = (cells + 0.5) * CELL - HALF - place
        cells = cells[np.hypot(away[:, 0], away[:, 1]) < radius]
        chosen = cells[:, 0], cells[:, 1]
        self._evidence[chosen] = np.minimum(self._evidence[chosen], 0.0)
        return chosen

    def show(self, floor: Array, strange: Array) -> None:
        """Take in which floor another camera saw.

        A cell beside one that shows anything else stays as it was: where an
        image was taken is known to a few centimetres.

        Args:
            floor: Places whose pixels look like floor, in [m]. Shape (n, 2).
            strange: Places whose pixels do not, in [m]. Shape (m, 2).
        """
        bare, other = self._counts(floor), self._counts(strange)
        mixed = np.pad(other >= np.maximum(1.0, MIXED * (bare + other)), 1)
        beside = sliding_window_view(mixed, (3, 3)).any(axis=(2, 3))
        self._seen |= (bare >= FEW) & ~beside
        self.version += 1

    def is_free(self, points: Array) -> NDArray[np.bool_]:
        """Whether rays have passed over places that nothing stands at.

        Args:
            points: In odometry, in [m]. Shape (n, 2).
        """
        inside = np.abs(points).max(axis=1, initial=0.0) < HALF
        found = np.zeros(len(points), dtype=np.bool_)
        cells = self._cells(points[inside])
        found[inside] = self._evidence[cells[:, 0], cells[:, 1]] <= PASSED
        return found

    def _counts(self, points: Array) -> NDArray[np.int64]:
        """How many of some places lie in each cell."""
        cells = self._cells(points)
        counts = np.zeros((SIDE, SIDE), dtype=np.int64)
        np.add.at(counts, (cells[:, 0], cells[:, 1]), 1)
        return counts

    def taken(self) -> tuple[Polygon, ...]:
        """What stands there, as far as it was seen, in odometry."""
        return cover(_centres(self._evidence > TAKEN), CELL)

    def holds(self, x: float, y: float) -> bool:
        """Whether something of the room stands at a place, in [m]."""
        away = self._taken_from(x, y)
        return bool(np.hypot(away[:, 0], away[:, 1]).min(initial=inf) < SAME)

    def nearest(self, x: float, y: float, facing: float, half: float) -> float:
        """Distance to what is nearest in a cone, in [m]; infinite if nothing.

        Args:
            x: Where the cone begins, in [m].
            y: Likewise.
            facing: Direction of its axis, in [rad].
            half: Half of its opening, in [rad].
        """
        away = self._taken_from(x, y)
        aside = np.arctan2(away[:, 1], away[:, 0]) - facing
        inside = np.abs(wrap_angles(aside)) < half
        return float(np.hypot(*away[inside].T).min(initial=inf))

    def _taken_from(self, x: float, y: float) -> Array:
        """Ways from a place to all taken cells, in [m]. Shape (n, 2)."""
        away: Array = _centres(self._evidence > TAKEN) - (x, y)
        return away

    def unseen(self, place: tuple[float, float]) -> tuple[Polygon, ...]:
        """Floor near a place that nobody has seen yet, in odometry.

        Args:
            place: Own axis, in [m].
        """
        first = self._cells(np.array([place]))[0] - WINDOW
        first = np.clip(first, 0, SIDE - 2 * WINDOW)
        window = tuple(slice(i, i + 2 * WINDOW) for i in first.tolist())
        hidden = ~self._seen[window]
        dark = _broad(hidden | (self._evidence[window] > TAKEN))
        centres = _centres(dark & hidden) + first * CELL
        x, y = (centres - place).T
        near = np.hypot(x, y) < NEARBY
        centres, turned = centres[near], np.arctan2(y, x)[near]
        # The hull of a broad part would hold the floor on which one stands.
        sectors = np.floor(turned / SECTOR)
        return tuple(
            part
            for sector in np.unique(sectors)
            for part in cover(centres[sectors == sector], CELL, TIGHT)
        )

    @staticmethod
    def _cells(points: Array) -> NDArray[np.int64]:
        """Cells of points that lie on the map. Shape (n, 2)."""
        cells = np.floor((points + HALF) / CELL).astype(np.int64)
        inside = np.all((cells >= 0) & (cells < SIDE), axis=1)
        found: NDArray[np.int64] = cells[inside]
        return found


def _broad(chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells of squares of three by three that are chosen, and beside them.

    Strips that are narrower are noise; the rim of something round is not.
    """
    whole = sliding_window_view(chosen, (3, 3)).all(axis=(2, 3))
    square = sliding_window_view(np.pad(whole, 2), (3, 3)).any(axis=(2, 3))
    wide = sliding_window_view(np.pad(square, 1), (3, 3))
    found: NDArray[np.bool_] = np.any(wide, axis=(2, 3)) & chosen
    return found


def _beside(chosen: NDArray[np.bool_], steps: int) -> NDArray[np.bool_]:
    """Columns that are chosen, and those within some steps of them."""
    wide = sliding_window_view(np.pad(chosen, steps), 2 * steps + 1)
    found: NDArray[np.bool_] = np.any(wide, axis=1)
    return found


def _centres(chosen: NDArray[np.bool_]) -> Array:
    """Middles of cells, in [m]. Shape (n, 2)."""
    cells = np.argwhere(chosen).astype(np.float64)
    centres: Array = (cells + 0.5) * CELL - HALF
    return centres
