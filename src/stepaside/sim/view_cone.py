"""Geoms outside the cone of view of a camera, which images leave out."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import cos, sin

import mujoco
import numpy as np

from ..core.poses import Array

HIDDEN_GROUP = 5  # geom group that no sensor shows


@contextmanager
def geoms_in_cone(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    position_in_world: Array,
    axis_in_world: Array,
    half_angle: float,
) -> Iterator[None]:
    """Hide the geoms whose bounding spheres lie outside a cone.

    Every image of a camera within the cone stays the same, and takes less
    time. Planes, which have no bounding sphere, are never hidden.

    Args:
        model: Model, whose geom groups are changed in the block.
        data: Its state.
        position_in_world: Apex of the cone, in [m]. Shape (3,).
        axis_in_world: Unit vector along its axis. Shape (3,).
        half_angle: Half of its opening angle, in [rad]; below pi / 2.
    """
    offsets = data.geom_xpos - position_in_world
    along = offsets @ axis_in_world
    squared = np.einsum("ij,ij->i", offsets, offsets) - along**2
    across = np.sqrt(np.maximum(squared, 0.0))
    # Distance from the surface of the cone; less than that from its apex.
    distances = across * cos(half_angle) - along * sin(half_angle)
    radii = model.geom_rbound
    hidden = np.flatnonzero((distances > radii) & (radii > 0.0))
    groups = model.geom_group
    shown = groups[hidden]
    groups[hidden] = HIDDEN_GROUP
    try:
        yield
    finally:
        groups[hidden] = shown
