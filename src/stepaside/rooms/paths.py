"""The shortest way around what stands on a floor."""

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, cos, pi

import numpy as np
from numpy.typing import NDArray

from ..poses import Array
from .room import Obstacle
from .shapes import Disc

ARC = pi / 8  # of a corner that one edge of a way goes around, in [rad]
KEPT = 0.4  # by which a way must be shorter to change sides, in [m]
GAP = 0.01  # by which ways keep farther from corners than they must, [m]
Point = tuple[float, float]


def first_point(
    solids: Sequence[Obstacle],
    start: Point,
    end: Point,
    radius: float,
    side: int = 0,
) -> Point:
    """Where a disc heads first on the shortest way to a point.

    Ways are straight but for corners, which they go around at a distance of
    the radius and 1 cm more, along edges of at most 22.5 degrees.

    Args:
        solids: What stands there.
        start: Where the disc is, (x, y), in [m].
        end: Where it is to go, likewise.
        radius: Of the disc, in [m]; where start or end are nearer to
            something, that may be as near.
        side: On which side of the line to the end, left (1) or right (-1),
            it prefers to go, unless the way is 0.4 m longer.

    Returns:
        The end if the way there is straight, or if there is none; else the
        first corner of the shortest way.
    """
    floor = _floor(tuple(solids), radius)
    near = np.array([start, end])
    allowed = np.array(
        [
            min(radius, float(solid.clearance(near).min()) - 1e-9)
            for solid in solids
        ]
    )
    if floor.free(allowed, near[0], near[1:])[0]:
        return end
    corners = floor.corners
    count = len(corners)
    out = floor.ways(allowed, near[0])
    (x, y), (u, v) = start, end
    left = (u - x) * (corners[:, 1] - y) - (v - y) * (corners[:, 0] - x)
    best = out + np.where(side * left < 0.0, KEPT, 0.0)
    back = floor.ways(allowed, near[1])
    first, done = np.arange(count), np.zeros(count, dtype=np.bool_)
    for _ in range(count):
        number = int(np.where(done, np.inf, best).argmin())
        # What is farther than a whole way can be on no shorter one.
        if done[number] or not best[number] < (best + back).min():
            break
        done[number] = True
        come = best[number] + floor.between(number)
        shorter = come < best - 1e-12
        first = np.where(shorter, first[number], first)
        best = np.where(shorter, come, best)
    whole = best + back
    if not count or not np.isfinite(whole.min()):
        return end
    x, y = corners[first[int(whole.argmin())]].tolist()
    return x, y


class _Floor:
    """What stands on a floor, with the corners of the ways around it.

    Attributes:
        corners: Corners, in [m]. Shape (n, 2).
    """

    def __init__(self, solids: tuple[Obstacle, ...], radius: float) -> None:
        """Find the corners for a disc of a radius, in [m]."""
        discs = [(n, s) for n, s in enumerate(solids) if isinstance(s, Disc)]
        self._discs = np.array([n for n, _ in discs], dtype=np.int64)
        self._centres = np.array([s.centre for _, s in discs]).reshape(-1, 2)
        self._radii = np.array([s.radius for _, s in discs])
        begins, ends, owners = [np.zeros((0, 2))], [np.zeros((0, 2))], []
        for number, solid in enumerate(solids):
            if not isinstance(solid, Disc):
                begins.append(solid.points)
                ends.append(np.roll(solid.points, -1, axis=0))
                owners += [number] * len(solid.points)
        self._begins, self._ends = np.concatenate(begins), np.concatenate(ends)
        self._owners = np.array(owners, dtype=np.int64)
        self.corners = _corners(solids, radius)
        self._allowed = np.full(len(solids), radius)
        self._between: dict[int, Array] = {}

    def between(self, number: int) -> Array:
        """Lengths of the ways from a corner to all, in [m]. Shape (n,)."""
        if number not in self._between:
            corner = self.corners[number]
            self._between[number] = self.ways(self._allowed, corner)
        return self._between[number]

    def ways(self, allowed: Array, place: Array) -> Array:
        """Lengths of straight ways to all corners; infinite if not free."""
        found: Array = np.where(
            self.free(allowed, place, self.corners),
            np.hypot(*(self.corners - place).T),
            np.inf,
        )
        return found

    def free(
        self, allowed: Array, start: Array, ends: Array
    ) -> NDArray[np.bool_]:
        """Whether lines keep as far from everything as they must.

        Args:
            allowed: Distance from each solid, in [m], which start and ends
                keep. Shape (solids,).
            start: Where all lines begin, in [m]. Shape (2,).
            ends: Where they end. Shape (n, 2).
        """
        around = np.maximum(1e-3, self._radii + allowed[self._discs])
        clear = allowed[self._owners]
        free: NDArray[np.bool_] = np.all(
            _apart(self._centres, start, ends) > around, axis=1
        )
        free &= (_apart(self._begins, start, ends) >= clear).all(axis=1)
        free[free] &= ~self._met(start, ends[free])
        return free

    def _met(self, start: Array, ends: Array) -> NDArray[np.bool_]:
        """Whether lines from a place meet an edge. Shape (n,)."""
        edges, along = self._ends - self._begins, ends - start
        to = self._begins - start
        cross = along[:, :1] * edges[:, 1] - along[:, 1:] * edges[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = (to[:, 0] * edges[:, 1] - to[:, 1] * edges[:, 0]) / cross
            aside = (to[:, 0] * along[:, 1:] - to[:, 1] * along[:, :1]) / cross
        inside = (ahead >= 0.0) & (ahead <= 1.0)
        met: NDArray[np.bool_] = np.any(
            inside & (aside >= 0.0) & (aside <= 1.0), axis=1
        )
        return met


_floor = lru_cache(maxsize=16)(_Floor)


def _apart(points: Array, start: Array, ends: Array) -> Array:
    """Distances of points from lines, in [m]. Shape (lines, points)."""
    along, away = ends - start, points - start
    squares = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(along @ away.T / squares[:, None], 0.0, 1.0)
    found: Array = np.hypot(
        away[:, 0] - share * along[:, :1], away[:, 1] - share * along[:, 1:]
    )
    return found


def _corners(solids: tuple[Obstacle, ...], radius: float) -> Array:
    """Corners of the ways around solids, in [m]. Shape (n, 2)."""
    found = [np.zeros((0, 2))]
    for solid in solids:
        if isinstance(solid, Disc):
            away = solid.radius + radius + GAP
            found.append(np.array(solid.centre) + _arc(0.0, 2 * pi, away))
            continue
        facing = np.arctan2(solid.normals[:, 1], solid.normals[:, 0])
        for corner, before, after in zip(
            solid.points, np.roll(facing, 1), facing, strict=True
        ):
            turn = float((after - before) % (2.0 * pi))
            arc = _arc(float(before), turn, radius + GAP)
            found.append(corner + arc)
    corners = np.concatenate(found)
    for solid in solids:
        corners = corners[solid.clearance(corners) >= radius]
    return corners


def _arc(begin: float, turn: float, radius: float) -> Array:
    """Corners around an arc, outside of it. Shape (n, 2)."""
    count = max(1, ceil(turn / ARC - 1e-9))
    half = 0.5 * turn / count
    angles = begin + half * (2.0 * np.arange(count) + 1.0)
    out = radius / cos(half)
    found: Array = out * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return found
