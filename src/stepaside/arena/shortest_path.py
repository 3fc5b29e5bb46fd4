"""The shortest way around what stands on a floor."""

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, cos, pi, tau

import numpy as np

from ..core.poses import Array
from .obstacles import Obstacle, obstacle_set

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
    known = tuple(solids)
    near, around = np.array([start, end]), obstacle_set(known)
    clear = around.clearances(near).min(axis=0)
    allowed = np.minimum(radius, clear - 1e-9)
    if around.keep_clear(allowed, near[0], near[1:])[0]:
        return end
    floor = _floor(known, radius)
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
        self._known = obstacle_set(solids)
        corners = _corners(solids, radius)
        clear = self._known.clearances(corners) >= radius
        self.corners: Array = corners[clear.all(axis=1)]
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
            self._known.keep_clear(allowed, place, self.corners),
            np.hypot(*(self.corners - place).T),
            np.inf,
        )
        return found


_floor = lru_cache(maxsize=16)(_Floor)


def _corners(solids: tuple[Obstacle, ...], radius: float) -> Array:
    """Corners of the ways around each solid alone, in [m]. Shape (n, 2)."""
    found = [np.zeros((0, 2))]
    for solid in solids:
        away = solid.hull.radius + radius + GAP
        after = np.arctan2(*solid.hull.normals.T[::-1])
        begins = np.roll(after, 1)
        turns = (after - begins) % tau if len(after) > 1 else [tau]
        for corner, begin, turn in zip(
            solid.points, begins, turns, strict=True
        ):
            found.append(corner + _arc(float(begin), float(turn), away))
    return np.concatenate(found)


def _arc(begin: float, turn: float, radius: float) -> Array:
    """Corners around an arc, outside of it. Shape (n, 2)."""
    count = max(1, ceil(turn / ARC - 1e-9))
    half = 0.5 * turn / count
    angles = begin + half * (2.0 * np.arange(count) + 1.0)
    out = radius / cos(half)
    found: Array = out * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return found
