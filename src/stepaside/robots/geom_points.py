"""Points on the surfaces of a model's geoms."""

from itertools import product

import mujoco
import numpy as np

from ..core.poses import Array

TYPES = mujoco.mjtGeom


def geom_points_in_world(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int
) -> Array:
    """Return points (n, 3) in the world [m] that span a geom.

    Round geoms give their extreme points along the axes of the world;
    planes and height fields give none.
    """
    kind = int(model.geom_type[geom])
    size = model.geom_size[geom]
    position = data.geom_xpos[geom]
    axes = data.geom_xmat[geom].reshape(3, 3)
    if kind == TYPES.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        count = int(model.mesh_vertnum[mesh])
        vertices = model.mesh_vert[first : first + count].astype(np.float64)
        points: Array = position + vertices @ axes.T
        return points
    if kind == TYPES.mjGEOM_BOX:
        points = position + _corners(size) @ axes.T
        return points
    if kind == TYPES.mjGEOM_CYLINDER:
        angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        ring = size[0] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        rims = [np.c_[ring, np.full(24, z)] for z in (-size[1], size[1])]
        points = position + np.concatenate(rims) @ axes.T
        return points
    if kind == TYPES.mjGEOM_SPHERE:
        return _ball(position, size[0])
    if kind == TYPES.mjGEOM_CAPSULE:
        ends = [position + z * axes[:, 2] for z in (-size[1], size[1])]
        return np.concatenate([_ball(end, size[0]) for end in ends])
    if kind == TYPES.mjGEOM_ELLIPSOID:
        # Extent along each axis of the world.
        reach = np.sqrt(((axes * size) ** 2).sum(axis=1))
        return np.array(
            [position + s * r for s in (-1, 1) for r in np.diag(reach)]
        )
    return np.zeros((0, 3))


def _corners(size: Array) -> Array:
    corners: Array = np.array(list(product((-1, 1), repeat=3))) * size
    return corners


def _ball(position: Array, radius: float) -> Array:
    """Return the extreme points of a ball along the axes."""
    points: Array = position + radius * np.vstack([np.eye(3), -np.eye(3)])
    return points
