"""Motions, and grids over the poses of a robot in the frame of another."""

from math import ceil, cos, pi, sqrt, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.poses import Array, arc

PARTS = 4  # of a period, in which the distance is measured


def sub_poses(twists: ArrayLike, duration: float) -> Array:
    """Return poses along arcs at the ends of the parts of a duration.

    Args:
        twists: Velocities ahead [m/s], to the left [m/s] and turning [rad/s],
            held in the frame of the body. Shape (n, 3).
        duration: Duration, in [s].

    Returns:
        Poses in the initial frame, in [m] and [rad]. Shape (n, PARTS, 3).
    """
    rates = np.atleast_2d(np.asarray(twists, dtype=np.float64))
    times = duration * np.arange(1, PARTS + 1) / PARTS
    return arc(*(rates.T[:, :, None] * times))


class PoseGrid(NamedTuple):
    """Grid over the poses of a robot in the frame of its opponent.

    On a grid of one heading the robot faces along the line of sight, away
    from its opponent.
    """

    left: float  # x of the first node, in [m]
    spacing: float  # spacing of positions, in [m]
    shape: tuple[int, int, int]  # nodes along x, y and the heading
    # Y of the first node, in [m]; from 0 on the values of the other half are
    # those of the mirror image.
    right: float = 0.0

    @classmethod
    def covering(
        cls,
        spacing: float,
        ahead: float,
        behind: float,
        aside: float,
        headings: int = 1,
    ) -> "PoseGrid":
        """Return the left half, with a node at the opponent.

        Edges lie at distances ahead of the opponent, behind and beside it, in
        [m].
        """
        back = ceil(behind / spacing)
        nodes = back + ceil(ahead / spacing) + 1, ceil(aside / spacing) + 1
        return cls(-spacing * back, spacing, (*nodes, headings))

    def whole(self) -> "PoseGrid":
        """Return the grid of both halves."""
        i, j, k = self.shape
        right = -self.spacing * (j - 1)
        return PoseGrid(self.left, self.spacing, (i, 2 * j - 1, k), right)

    def axes(self) -> tuple[Array, Array, Array]:
        """Return the coordinates of the nodes, in [m], [m] and [rad]."""
        i, j, k = (np.arange(n, dtype=np.float64) for n in self.shape)
        x: Array = self.left + self.spacing * i
        y: Array = self.right + self.spacing * j
        theta: Array = tau / self.shape[2] * k
        return x, y, theta

    def distances(self, most: float) -> Array:
        """Return the distances of the nodes, cut off. Shape ``shape``."""
        x, y, theta = self.axes()
        found: Array = np.minimum(np.hypot(x[:, None], y), most)
        return np.repeat(found[:, :, None], len(theta), axis=2)

    @property
    def edge(self) -> float:
        """Distance of the edge to the left of the opponent, in [m]."""
        return self.right + self.spacing * (self.shape[1] - 1)

    @property
    def farthest(self) -> float:
        """Distance of the farthest node, in [m]."""
        x, y, _ = self.axes()
        return float(np.hypot(np.abs(x).max(), np.abs(y).max()))


def mirrored(values: Array) -> Array:
    """Return the values of mirrored poses, at nodes of a whole grid."""
    headings = -np.arange(values.shape[2]) % values.shape[2]
    return values[:, ::-1, headings]


def whole_values(values: Array) -> Array:
    """Return the values at the nodes of both halves of a grid."""
    return np.concatenate([mirrored(values)[:, :-1], values], axis=1)


def least_within(values: Array, grid: PoseGrid, radius: float) -> Array:
    """Return the least values within a displacement of the position, in [m].

    Values are interpolated linearly between nodes; eight directions of the
    displacement are tried.
    """
    found = values
    times = max(1, ceil(radius / grid.spacing))
    share = radius / times / grid.spacing / cos(pi / 8)
    for _ in range(times if radius > 0.0 else 0):
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
