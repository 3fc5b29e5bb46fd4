"""Clearance from obstacles in compiled loops."""

from math import inf, sqrt

from ...arena.obstacles import PackedObstacles
from ...theory.unicycle.compilation import inlined


@inlined
def clearance_at(
    packed: PackedObstacles, x: float, y: float, enough: float
) -> float:
    """Return the clearance of a point, up to a limit.

    Args:
        packed: Obstacles.
        x: Coordinate of the point, in [m].
        y: Coordinate of the point, in [m].
        enough: Largest distance of interest, in [m].

    Returns:
        Signed distance, negative inside, at most ``enough``, in [m].
    """
    nearest = enough
    discs, edges, firsts = packed.discs, packed.edges, packed.firsts
    for i in range(discs.shape[0]):
        dx, dy = x - discs[i, 0], y - discs[i, 1]
        reach = nearest + discs[i, 2]
        square = dx * dx + dy * dy
        if square < reach * reach:
            nearest = min(nearest, sqrt(square) - discs[i, 2])
    for k in range(firsts.shape[0] - 1):
        dx, dy = x - packed.rounds[k, 0], y - packed.rounds[k, 1]
        reach = nearest + packed.rounds[k, 2]
        if dx * dx + dy * dy > reach * reach and reach > 0.0:
            continue
        beyond = -inf
        for i in range(firsts[k], firsts[k + 1]):
            height = edges[i, 0] * x + edges[i, 1] * y - edges[i, 2]
            if height > beyond:
                beyond = height
                if beyond >= nearest:
                    break
        if beyond >= nearest:
            continue
        if beyond > 0.0:
            square = inf
            for i in range(firsts[k], firsts[k + 1]):
                # The edge runs to the left of its normal.
                dx, dy = x - edges[i, 3], y - edges[i, 4]
                along = dy * edges[i, 0] - dx * edges[i, 1]
                along = min(max(along, 0.0), edges[i, 5])
                dx += along * edges[i, 1]
                dy -= along * edges[i, 0]
                square = min(square, dx * dx + dy * dy)
            beyond = sqrt(square)
        nearest = min(nearest, beyond)
    return nearest
