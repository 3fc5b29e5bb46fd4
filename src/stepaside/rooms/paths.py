"""The shortest way around what stands on a floor."""

from collections.abc import Sequence
from functools import lru_cache
from math import ceil, cos, pi

import numpy as np
from numpy.typing import NDArray

from ..poses import Array
from .distance import crosses
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
    standing = tuple(solids)
    near = np.array([start, end])
    allowed = [
        min(radius, float(solid.clearance(near).min()) - 1e-9)
        for solid in standing
    ]
    if _free(standing, allowed, near[:1], near[1:])[0]:
        return end
    corners, between = _corners(standing, radius)
    count = len(corners)
    out = _sight(standing, allowed, start, corners)
    (x, y), (u, v) = start, end
    left = (u - x) * (corners[:, 1] - y) - (v - y) * (corners[:, 0] - x)
    out = out + np.where(side * left < 0.0, KEPT, 0.0)
    back = _sight(standing, allowed, end, corners)
    first = np.arange(count)
    best, done = out, np.zeros(count, dtype=np.bool_)
    for _ in range(count):
        number = int(np.where(done, np.inf, best).argmin())
        if done[number] or not np.isfinite(best[number]):
            break
        done[number] = True
        come = best[number] + between[number]
        shorter = come < best - 1e-12
        first = np.where(shorter, first[number], first)
        best = np.where(shorter, come, best)
    whole = best + back
    if not count or not np.isfinite(whole.min()):
        return end
    x, y = corners[first[int(whole.argmin())]].tolist()
    return x, y


def _sight(
    solids: Sequence[Obstacle],
    allowed: Sequence[float],
    place: Point,
    corners: Array,
) -> Array:
    """Distances of corners that are free to go to from a place. (n,)."""
    here = np.repeat(np.array([place]), len(corners), axis=0)
    found: Array = np.where(
        _free(solids, allowed, here, corners),
        np.hypot(*(corners - here).T),
        np.inf,
    )
    return found


def _free(
    solids: Sequence[Obstacle],
    allowed: Sequence[float],
    starts: Array,
    ends: Array,
) -> NDArray[np.bool_]:
    """Whether lines keep as far from solids as they must. Shape (n,)."""
    free: NDArray[np.bool_] = np.ones(len(starts), dtype=np.bool_)
    for solid, radius in zip(solids, allowed, strict=True):
        if isinstance(solid, Disc):
            around = max(1e-3, solid.radius + radius)
            free &= ~crosses(Disc(solid.x, solid.y, around), starts, ends)
            continue
        free &= ~crosses(solid, starts, ends)
        free &= solid.clearance(starts) >= radius
        free &= solid.clearance(ends) >= radius
        for corner in solid.points:
            free &= _apart(corner, starts, ends) >= radius
    return free


def _apart(point: Array, starts: Array, ends: Array) -> Array:
    """Distance of a point from lines, in [m]. Shape (n,)."""
    along, away = ends - starts, point - starts
    squares = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip((away * along).sum(axis=1) / squares, 0.0, 1.0)
    away = away - share[:, None] * along
    found: Array = np.hypot(away[:, 0], away[:, 1])
    return found


@lru_cache(maxsize=16)
def _corners(
    solids: tuple[Obstacle, ...], radius: float
) -> tuple[Array, Array]:
    """Corners of the ways around solids, and the ways between each two.

    Returns:
        Corners, in [m], and lengths of the straight ways, infinite where
        something is in the way. Shapes (n, 2), (n, n).
    """
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
    allowed = [radius] * len(solids)
    rows = [_sight(solids, allowed, c, corners) for c in corners.tolist()]
    return corners, np.array(rows).reshape(len(corners), len(corners))


def _arc(begin: float, turn: float, radius: float) -> Array:
    """Corners around an arc, outside of it. Shape (n, 2)."""
    count = max(1, ceil(turn / ARC - 1e-9))
    half = 0.5 * turn / count
    angles = begin + half * (2.0 * np.arange(count) + 1.0)
    out = radius / cos(half)
    found: Array = out * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    return found
