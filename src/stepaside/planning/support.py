"""How far a ZMP stays inside the support polygon."""

import numpy as np

from ..poses import Array
from .footsteps import Foot
from .settings import Sole


def sole_corners(pose: Array, foot: Foot, sole: Sole) -> Array:
    """Corners of a sole in the frame of its pose.

    Args:
        pose: Foot frame (x [m], y [m], theta [rad]). Shape (3,).
        foot: Side.
        sole: Shape of a left sole.

    Returns:
        Corners, in [m]. Shape (4, 2).
    """
    x, y, theta = pose
    left = np.array(
        [
            [sole.front, sole.outer],
            [sole.back, sole.outer],
            [sole.back, -sole.inner],
            [sole.front, -sole.inner],
        ]
    )
    left[:, 1] *= foot.value
    c, s = np.cos(theta), np.sin(theta)
    corners: Array = left @ np.array([[c, s], [-s, c]]) + (x, y)
    return corners


def convex_hull(points: Array) -> Array:
    """Corners of the convex hull, counter-clockwise. Shapes (n, 2), (m, 2).

    Andrew's monotone chain.
    """
    ordered = sorted(map(tuple, points.tolist()))
    hull: list[tuple[float, ...]] = []
    for chain in (ordered, ordered[::-1]):
        begun = len(hull)
        for p in chain:
            while len(hull) >= begun + 2:
                (ax, ay), (bx, by) = hull[-2], hull[-1]
                if (bx - ax) * (p[1] - ay) > (by - ay) * (p[0] - ax):
                    break
                hull.pop()
            hull.append(p)
        hull.pop()
    return np.array(hull)


def margin_inside(points: Array, polygon: Array) -> Array:
    """Distance of points from the nearest edge of a convex polygon.

    Args:
        points: In [m]. Shape (n, 2).
        polygon: Corners, counter-clockwise. Shape (m, 2).

    Returns:
        Distances, in [m], negative outside. Shape (n,).
    """
    edges = np.roll(polygon, -1, axis=0) - polygon
    normals = np.column_stack([-edges[:, 1], edges[:, 0]])
    normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
    offsets = (points[:, None, :] - polygon[None]) * normals[None]
    margin: Array = offsets.sum(axis=2).min(axis=1)
    return margin
