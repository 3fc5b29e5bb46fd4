"""Least values of the shield game within a disturbance of the state."""

from math import ceil, cos, pi, sqrt

import numpy as np

from ...core.poses import Array
from .shield_game import PoseGrid, mirrored


def eroded_values(v: Array, grid: PoseGrid, loss: float) -> Array:
    """Return the least values within a displacement.

    Values are interpolated linearly between nodes; eight directions of the
    displacement are tried.

    Args:
        v: Values of the nodes.
        grid: Their grid.
        loss: Radius of the displacement, in [m].
    """
    found = v
    times = max(1, ceil(loss / grid.spacing))
    share = loss / times / grid.spacing / cos(pi / 8)
    for _ in range(times if loss > 0.0 else 0):
        # One more node on every side: mirrored at y = 0, else kept.
        around = np.pad(found, ((1, 1), (1, 1), (0, 0)), mode="edge")
        if grid.right == 0.0:
            around[1:-1, 0] = mirrored(found[:, 1:2])[:, 0]
            around[0, 0], around[-1, 0] = around[1, 0], around[-2, 0]
        least = found
        for di in (-1, 0, 1):
            for dj in (-1, 0, 1):
                if di or dj:
                    part = share / sqrt(di * di + dj * dj)
                    there = around[
                        1 + di : 1 + di + len(found),
                        1 + dj : 1 + dj + found.shape[1],
                    ]
                    least = np.minimum(
                        least, (1.0 - part) * found + part * there
                    )
        found = least
    return found
