"""Occupancy grid of the floor from depth images."""

from math import inf

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ..arena import Polygon
from ..core.convex import Point, lower_hull, signed_area
from ..core.poses import Array
from ..robots.robot_tree import NAO_SIZE, OWN_MARGIN, BodySize
from .camera_model import CameraPose
from .images import DepthImage

# Largest area of a hull over that of its cells; a diagonal line of cells
# has 2.
LOOSE = 2.2
Indices = NDArray[np.int64]


def cover(
    centres: Array, cell: float, loose: float = LOOSE
) -> tuple[Polygon, ...]:
    """Return convex polygons, in [m], whose union contains every cell.

    A set of cells that fills its hull poorly is split across its longer
    principal axis, at the widest gap if there is one: a corner of two walls
    becomes two polygons. ``loose`` is the largest ratio of the areas.
    """
    points = np.asarray(centres, dtype=np.float64)
    first = points.min(axis=0, initial=np.inf)
    cells = np.rint((points - first) / cell).astype(np.int64)
    polygons: list[Polygon] = []
    waiting = [np.arange(len(points))] if len(points) else []
    while waiting:
        chosen = waiting.pop()
        corners = np.array(_hull_of_cells(cells[chosen]))
        if len(chosen) < 2 or signed_area(corners) <= loose * len(chosen):
            around = np.round(first + cell * (corners - 0.5), 9).tolist()
            polygons.append(Polygon(tuple((x, y) for x, y in around)))
        else:
            parts = _split(points[chosen], cell)
            waiting += [chosen[part] for part in parts]
    return tuple(polygons)


def _hull_of_cells(cells: Indices) -> list[Point]:
    """Return the hull of cells; cell (i, j) is the square from (i, j) on.

    Only the lowest and the highest cell of a column can have a corner.
    """
    columns, rows = cells.T
    begin = int(columns.min())
    width = int(columns.max()) - begin + 2
    lowest = np.full(width, np.iinfo(np.int64).max)
    highest = np.full(width, -1)
    for side in (0, 1):
        np.minimum.at(lowest, columns - begin + side, rows)
        np.maximum.at(highest, columns - begin + side, rows + 1)
    present = highest >= 0
    x = (np.flatnonzero(present) + begin).tolist()
    low, high = lowest[present].tolist(), highest[present].tolist()
    upper = list(zip(x, high, strict=True))[::-1]
    return lower_hull(list(zip(x, low, strict=True))) + lower_hull(upper)


def _split(points: Array, cell: float) -> tuple[Indices, Indices]:
    """Split two or more cells with given centres; return their indices."""
    about = points - points.mean(axis=0)
    axis = np.linalg.eigh(about.T @ about)[1][:, -1]
    along = about @ axis
    order = np.argsort(along, kind="stable")
    gaps = np.diff(along[order])
    widest = int(gaps.argmax())
    if gaps[widest] < 2.0 * cell:
        widest = len(points) // 2 - 1
    return order[: widest + 1], order[widest + 1 :]


CELL = 0.05  # side of a cell, in [m]
HALF_SIDE = 6.0  # of the map around the start, in [m]
SIDE = round(2.0 * HALF_SIDE / CELL)
LOW = 0.07  # lowest point of an obstacle, in [m]
HIGHER = 0.13  # than the standing robot a walking one is, at most, in [m]
MAX_RAY_HEIGHT = 0.5  # below it a ray shows that the floor is free, in [m]
OPPONENT = 0.32  # points nearer to the opponent belong to it, in [m]
BEARING_ERROR = 0.05  # largest error of the direction of a column, in [rad]
EVIDENCE_MARGIN = 0.1  # from the end of free evidence to the hit, in [m]
KNOWN_MARGIN = 0.03  # from the end of known floor to the hit, in [m]
FREE_AT_START = 0.35  # radius of free floor around the start, in [m]
FREE_AT_OPPONENT = 0.06  # radius of free floor at the opponent, in [m]
# Radius around the opponent in which hits are erased that it caused before it
# was first recognised, in [m].
ERASED_AT_OPPONENT = 0.2
RAY_START = 0.3  # distance from the own axis at which rays start, in [m]
HIT = 1.0  # log-odds evidence of a ray that ends in a cell
PASS = -0.35  # evidence of a ray that passes over a cell
MIN_EVIDENCE = -2.0
MAX_EVIDENCE = 5.0
OCCUPIED = 1.5  # evidence of an occupied cell: two images
TIGHTNESS = 1.2  # of polygons over unknown floor, which leave the free out
NEARBY = 1.2  # distance within which unknown floor is reported, in [m]
WINDOW = round(NEARBY / CELL) + 2  # half side of that area, in [cells]
TOLERANCE = 0.2  # from a measured point to its obstacle on the map, in [m]
SECTOR = np.pi / 8  # angle spanned by a polygon of unknown floor, in [rad]
# Offsets from a cell to all cells around it.
STENCIL = np.argwhere(np.ones((17, 17))) - 8

Cells = tuple[NDArray[np.int64], NDArray[np.int64]]


class FloorMap:
    """Occupancy grid with occupied, free and unknown cells, in odometry.

    A ray of a depth image adds evidence to the cell where it hits an
    obstacle, and subtracts evidence from cells that it passes: cells that an
    obstacle has left become free when observed again. The opponent is left
    out; hits on it before it was recognised are erased. The floor around the
    start is free. Floor nearer than the range of the camera, or out of its
    view, stays unknown until a ray passes over it.
    """

    def __init__(self) -> None:
        self._evidence = np.zeros((SIDE, SIDE))
        self._known = np.zeros((SIDE, SIDE), dtype=np.bool_)
        self._recognised = False
        self.version = 0

    def take(
        self,
        image: DepthImage,
        camera: CameraPose,
        position_opponent_in_odometry: tuple[float, float] | None,
        size: BodySize = NAO_SIZE,
    ) -> None:
        """Add a depth image; the opponent is None if it is not tracked."""
        depths = image.depths.astype(np.float64)
        points = camera.position_in_odometry + depths[..., None] * (
            camera.rays(image.camera)
        )
        own = camera.position_torso_in_odometry
        valid = (depths > 0.0) & (depths < 0.97 * image.far)
        heights = points[..., 2]
        slack = LOW + 0.01 * depths
        if not self.version:
            self._free_around(own, FREE_AT_START)
        hits = valid & (heights > slack) & (heights < size.height + HIGHER)
        flat = points[..., :2] - np.array(own)
        distances = np.hypot(flat[..., 0], flat[..., 1])
        hits &= distances > size.radius + OWN_MARGIN
        opponents = np.zeros_like(hits)
        if position_opponent_in_odometry is not None:
            apart = points[..., :2] - np.array(position_opponent_in_odometry)
            opponents = np.hypot(apart[..., 0], apart[..., 1]) < OPPONENT
        low_enough = valid & (heights < MAX_RAY_HEIGHT)
        beside = round(BEARING_ERROR * image.camera.focal_x)
        near = np.ones(2 * beside + 1)
        blocked = np.convolve(~low_enough.any(axis=0), near, "same") > 0.5
        begin = np.where(blocked, image.near, RAY_START)
        self._add_free_rays(flat, distances, low_enough, hits, own, begin)
        # One pixel alone may be noise.
        hit_cells = self._counts(points[hits & ~opponents][:, :2]) > 1
        self._evidence[hit_cells] += HIT
        self._known |= hit_cells
        if position_opponent_in_odometry is not None:
            self._free_around(position_opponent_in_odometry, FREE_AT_OPPONENT)
            if not self._recognised:
                # Only once: later this would erase obstacles beside it.
                self._erase(position_opponent_in_odometry, ERASED_AT_OPPONENT)
                self._recognised = True
        np.clip(self._evidence, MIN_EVIDENCE, MAX_EVIDENCE, out=self._evidence)
        self.version += 1

    def _add_free_rays(
        self,
        flat: Array,
        distances: Array,
        low_enough: NDArray[np.bool_],
        hits: NDArray[np.bool_],
        position_own_in_odometry: tuple[float, float],
        begin: Array,
    ) -> None:
        """Subtract evidence along the rays of each column.

        An object too near for any depth blocks a whole column. The yaw of a
        turning head is known to a few degrees only, so columns beside a
        blocked one count from the near limit on.
        """
        far = np.where(low_enough, distances, 0.0)
        row = far.argmax(axis=0)
        columns = np.arange(far.shape[1])
        reach = far[row, columns]
        first = np.where(hits, distances, np.inf).min(axis=0)
        good = np.minimum(reach, first) > RAY_START
        if not good.any():
            return
        ahead = flat[row, columns][good] / far[row, columns][good][:, None]
        reach, first, begin = reach[good], first[good], begin[good]
        known = np.minimum(reach, first - KNOWN_MARGIN)
        self._known |= self._cells_along(
            position_own_in_odometry, ahead, begin, known
        )
        free = np.minimum(reach, first - EVIDENCE_MARGIN)
        self._evidence[
            self._cells_along(position_own_in_odometry, ahead, begin, free)
        ] += PASS

    def _cells_along(
        self,
        position_own_in_odometry: tuple[float, float],
        ahead: Array,
        begin: Array,
        reach: Array,
    ) -> NDArray[np.bool_]:
        """Return the cells between two distances along rays."""
        steps = np.arange(RAY_START, max(RAY_START, float(reach.max())), CELL)
        inside = (steps >= begin[:, None]) & (steps < reach[:, None])
        points: Array = (
            np.array(position_own_in_odometry)
            + steps[None, :, None] * ahead[:, None, :]
        )
        cells = self._cells(points[inside])
        found = np.zeros((SIDE, SIDE), dtype=np.bool_)
        found[cells[:, 0], cells[:, 1]] = True
        return found

    def _free_around(
        self, position: tuple[float, float], radius: float
    ) -> None:
        """Mark the floor around a player as free."""
        self._known[self._erase(position, radius)] = True

    def _erase(self, position: tuple[float, float], radius: float) -> Cells:
        """Erase evidence around a position, and return its cells."""
        cells = self._cells(np.array([position])) + STENCIL
        distances = (cells + 0.5) * CELL - HALF_SIDE - position
        cells = cells[np.hypot(distances[:, 0], distances[:, 1]) < radius]
        chosen = cells[:, 0], cells[:, 1]
        self._evidence[chosen] = np.minimum(self._evidence[chosen], 0.0)
        return chosen

    def _counts(self, points: Array) -> NDArray[np.int64]:
        """Return the number of points in each cell."""
        cells = self._cells(points)
        counts = np.zeros((SIDE, SIDE), dtype=np.int64)
        np.add.at(counts, (cells[:, 0], cells[:, 1]), 1)
        return counts

    def occupied_cells(self) -> Array:
        """Return the centres of occupied cells in odometry. Shape (n, 2)."""
        return _centres(self._evidence > OCCUPIED)

    def occupied(self) -> tuple[Polygon, ...]:
        """Return the occupied cells as polygons in odometry."""
        return cover(self.occupied_cells(), CELL)

    def is_occupied(self, x: float, y: float) -> bool:
        """Return whether a point in odometry, in [m], is occupied."""
        distances = self.occupied_cells() - (x, y)
        return bool(
            np.hypot(distances[:, 0], distances[:, 1]).min(initial=inf)
            < TOLERANCE
        )

    def unknown(self, position: tuple[float, float]) -> tuple[Polygon, ...]:
        """Return the unknown floor near a position as polygons in odometry."""
        first = self._cells(np.array([position]))[0] - WINDOW
        first = np.clip(first, 0, SIDE - 2 * WINDOW)
        window = tuple(slice(i, i + 2 * WINDOW) for i in first.tolist())
        hidden = ~self._known[window]
        dark = wide_areas(hidden | (self._evidence[window] > OCCUPIED))
        centres = _centres(dark & hidden) + first * CELL
        x, y = (centres - position).T
        near = np.hypot(x, y) < NEARBY
        centres, turned = centres[near], np.arctan2(y, x)[near]
        # One hull of a wide area would contain the robot itself.
        sectors = np.floor(turned / SECTOR)
        return tuple(
            part
            for sector in np.unique(sectors)
            for part in cover(centres[sectors == sector], CELL, TIGHTNESS)
        )

    @staticmethod
    def _cells(points: Array) -> NDArray[np.int64]:
        """Return the cells of points within the map. Shape (n, 2)."""
        cells = np.floor((points + HALF_SIDE) / CELL).astype(np.int64)
        inside = np.all((cells >= 0) & (cells < SIDE), axis=1)
        found: NDArray[np.int64] = cells[inside]
        return found


def wide_areas(chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return chosen cells in or beside squares of three by three.

    Narrower strips are noise, but the rim of a round area is not.
    """
    whole = sliding_window_view(chosen, (3, 3)).all(axis=(2, 3))
    square = sliding_window_view(np.pad(whole, 2), (3, 3)).any(axis=(2, 3))
    wide = sliding_window_view(np.pad(square, 1), (3, 3))
    found: NDArray[np.bool_] = np.any(wide, axis=(2, 3)) & chosen
    return found


def _centres(chosen: NDArray[np.bool_]) -> Array:
    """Return the centres of cells, in [m]. Shape (n, 2)."""
    cells = np.argwhere(chosen).astype(np.float64)
    centres: Array = (cells + 0.5) * CELL - HALF_SIDE
    return centres
