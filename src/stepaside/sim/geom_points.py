"""Points on the surfaces of a model's geoms."""

from itertools import product

import mujoco
import numpy as np

from ..core.poses import Array

TYPES = mujoco.mjtGeom


def points_of(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> Array:
    """Points that span a geom, in the world.

    Of round ones the lowest point and those farthest to all sides are among
    them; planes and height fields have none.

    Args:
        model: Compiled model.
        data: Its state.
        geom: Number of the geom.

    Returns:
        Places, in [m]. Shape (n, 3).
    """
    kind = int(model.geom_type[geom])
    size = model.geom_size[geom]
    place = data.geom_xpos[geom]
    axes = data.geom_xmat[geom].reshape(3, 3)
    if kind == TYPES.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first = int(model.mesh_vertadr[mesh])
        count = int(model.mesh_vertnum[mesh])
        own = model.mesh_vert[first : first + count].astype(np.float64)
        found: Array = place + own @ axes.T
        return found
    if kind == TYPES.mjGEOM_BOX:
        found = place + _corners(size) @ axes.T
        return found
    if kind == TYPES.mjGEOM_CYLINDER:
        turns = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        ring = size[0] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
        rims = [np.c_[ring, np.full(24, z)] for z in (-size[1], size[1])]
        found = place + np.concatenate(rims) @ axes.T
        return found
    if kind == TYPES.mjGEOM_SPHERE:
        return _ball(place, size[0])
    if kind == TYPES.mjGEOM_CAPSULE:
        ends = [place + z * axes[:, 2] for z in (-size[1], size[1])]
        return np.concatenate([_ball(end, size[0]) for end in ends])
    if kind == TYPES.mjGEOM_ELLIPSOID:
        # Farthest along an axis of the world: the semi-axes, turned.
        reach = np.sqrt(((axes * size) ** 2).sum(axis=1))
        return np.array(
            [place + s * r for s in (-1, 1) for r in np.diag(reach)]
        )
    return np.zeros((0, 3))


def _corners(size: Array) -> Array:
    corners: Array = np.array(list(product((-1, 1), repeat=3))) * size
    return corners


def _ball(place: Array, radius: float) -> Array:
    """Its lowest point, and those farthest along the axes."""
    found: Array = place + radius * np.vstack([np.eye(3), -np.eye(3)])
    return found
