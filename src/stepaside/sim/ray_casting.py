"""Rays from sensors, and the geoms in their view."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import cos, sin

import mujoco
import numpy as np

from ..core.poses import Array
from ..robots.head import Mount

VISIBLE = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)  # geom groups
HIDDEN_GROUP = 5  # geom group that no sensor shows
# MuJoCo drops a plane whose origin is beyond the cutoff: a floor would vanish
# before robots far from the origin of the world.
UNLIMITED = 1e10  # cutoff, in [m]


class RayCaster:
    """Rays from a mount on a body, which they ignore; misses are -1.

    Origin [m], directions and normals are in the world; ``along`` is the depth
    along the mount axis per distance.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        body: str,
        mount: Mount,
        rays: Array,
    ) -> None:
        self._model, self._data = model, data
        self._body, self._mount = model.body(body).id, mount
        lengths = np.linalg.norm(rays, axis=1)
        self._rays = rays / lengths[:, None]
        self.along = 1.0 / lengths
        self._half_angle = float(np.arccos(self._rays[:, 0].min()))
        self.geoms = np.zeros(len(rays), dtype=np.int32)
        self.distances = np.zeros(len(rays))
        self.normals = np.zeros((len(rays), 3))
        self.directions, self.origin = self._rays, np.zeros(3)

    def cast(self, cutoff: float = UNLIMITED) -> None:
        """Cast all rays up to a distance, in [m]; misses are -1."""
        model, data, body = self._model, self._data, self._body
        axes = data.xmat[body].reshape(3, 3)
        self.origin = data.xpos[body] + axes @ self._mount.position_in_body
        turned = axes @ self._mount.axes_in_body
        self.directions = self._rays @ turned.T
        forward, half = turned[:, 0], self._half_angle
        with geoms_in_cone(model, data, self.origin, forward, half):
            mujoco.mj_multiRay(
                *(model, data, self.origin, self.directions.reshape(-1)),
                *(VISIBLE, True, body, self.geoms, self.distances),
                *(self.normals.reshape(-1), len(self.directions), cutoff),
            )

    @property
    def slants(self) -> Array:
        """Cosines of the angles of incidence. Shape (n,)."""
        slants: Array = np.abs(
            np.einsum("ij,ij->i", self.directions, self.normals)
        )
        return slants


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
    radii, groups = model.geom_rbound, model.geom_group
    hidden = np.flatnonzero((distances > radii) & (radii > 0.0))
    shown = groups[hidden]
    groups[hidden] = HIDDEN_GROUP
    try:
        yield
    finally:
        groups[hidden] = shown
