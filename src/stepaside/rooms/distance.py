"""Distances between what stands on a floor, and lines across it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..poses import Array
from .shapes import Disc, Polygon


def clearance_between(footprint: Polygon, obstacle: Disc | Polygon) -> float:
    """Distance between a convex footprint and an obstacle, in [m].

    Args:
        footprint: A sole, or the hull of what moves.
        obstacle: In the same frame.

    Returns:
        Distance; where they overlap, minus the least way by which one of
        them would have to move for them not to.
    """
    if isinstance(obstacle, Disc):
        found = footprint.clearance([obstacle.centre])
        return float(found[0]) - obstacle.radius
    # Convex sets that lie apart do so along the normal of an edge; that
    # of two corners is found from the points of each to the other.
    gaps = [
        (other.points @ one.normals.T - one.offsets).min(axis=0).max()
        for one, other in ((footprint, obstacle), (obstacle, footprint))
    ]
    overlap = float(max(gaps))
    if overlap <= 0.0:
        return overlap
    return float(
        min(
            footprint.clearance(obstacle.points).min(),
            obstacle.clearance(footprint.points).min(),
        )
    )


def crosses(
    obstacle: Disc | Polygon, starts: ArrayLike, ends: ArrayLike
) -> NDArray[np.bool_]:
    """Whether straight lines touch an obstacle.

    Args:
        obstacle: The obstacle.
        starts: Where the lines begin, (x, y), in [m]. Shape (n, 2).
        ends: Where they end, likewise.

    Returns:
        Whether each does. Shape (n,).
    """
    start = np.asarray(starts, dtype=np.float64)
    along = np.asarray(ends, dtype=np.float64) - start
    if isinstance(obstacle, Disc):
        to_centre = np.asarray(obstacle.centre) - start
        squares = np.maximum((along**2).sum(axis=1), 1e-300)
        share = np.clip((to_centre * along).sum(axis=1) / squares, 0.0, 1.0)
        away = to_centre - share[:, None] * along
        near: NDArray[np.bool_] = (
            np.hypot(away[:, 0], away[:, 1]) <= obstacle.radius
        )
        return near
    return _clipped(obstacle, start, along)


def _clipped(
    polygon: Polygon, start: Array, along: Array
) -> NDArray[np.bool_]:
    """Whether anything of a line is left inside all edges."""
    height = start @ polygon.normals.T - polygon.offsets  # (n, m), [m]
    slope = along @ polygon.normals.T
    still = np.abs(slope) < 1e-12  # runs along the edge
    with np.errstate(divide="ignore", invalid="ignore"):
        share = -height / slope
    enters = np.where(~still & (slope < 0.0), share, 0.0).max(axis=1)
    leaves = np.where(~still & (slope > 0.0), share, 1.0).min(axis=1)
    outside = (still & (height > 0.0)).any(axis=1)
    found: NDArray[np.bool_] = (
        np.maximum(enters, 0.0) <= np.minimum(leaves, 1.0)
    ) & ~outside
    return found
