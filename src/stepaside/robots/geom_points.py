"""Points on the surfaces of a model's geoms."""

from itertools import product

import mujoco
import numpy as np

from ..core.poses import Array

TYPES = mujoco.mjtGeom
ROUND = (TYPES.mjGEOM_SPHERE, TYPES.mjGEOM_CAPSULE, TYPES.mjGEOM_ELLIPSOID)


def geom_points_in_world(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int
) -> Array:
    """Return points (n, 3) in the world [m] that span a geom.

    Round geoms give their extreme points along the axes of the world;
    planes and height fields give none.
    """
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    position, axes = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)
    points: Array = np.zeros((0, 3))
    if kind in ROUND:
        reach, half = np.full(3, size[0]), 0.0
        if kind == TYPES.mjGEOM_ELLIPSOID:
            reach = np.sqrt(((axes * size) ** 2).sum(axis=1))
        elif kind == TYPES.mjGEOM_CAPSULE:
            half = size[1]
        ends = position + np.outer((-half, half), axes[:, 2])
        extremes = np.vstack([np.diag(reach), -np.diag(reach)])
        points = (ends[:, None] + extremes).reshape(-1, 3)
        return points
    if kind == TYPES.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        points = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
    elif kind == TYPES.mjGEOM_BOX:
        points = np.array(list(product((-1, 1), repeat=3))) * size
    elif kind == TYPES.mjGEOM_CYLINDER:
        angles = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        ring = size[0] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        rims = [np.c_[ring, np.full(24, z)] for z in (-size[1], size[1])]
        points = np.concatenate(rims)
    points = position + points.astype(np.float64) @ axes.T
    return points
