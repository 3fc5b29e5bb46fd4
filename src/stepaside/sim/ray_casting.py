"""Cameras and sonars by casting rays: no graphics needed."""

import mujoco
import numpy as np

from ..core.poses import Array
from ..perception.camera_model import CameraModel
from ..perception.images import Depths, Pixels
from ..robots.head import Mount
from .camera_settings import DepthSettings, SonarSettings

SEEN = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)  # groups with a look
SKY = np.array([0.78, 0.84, 0.90])
SUN = np.array([-0.2, -0.3, 1.0]) / np.sqrt(1.13)  # where light comes from
AMBIENT, DIFFUSE = 0.55, 0.45
TILE = 0.5  # side of a square of the floor, in [m]
SLANT = 0.12  # least cosine at which a surface sends anything back
CONE_RAYS = 6  # across the cone of a sonar
UP = np.array([0.0, 0.0, 1.0])


class RayCaster:
    """Casts rays from a mount on a body, which itself is not hit."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        body: str,
        mount: Mount,
        rays: Array,
    ) -> None:
        """Prepare rays.

        Args:
            model: The world.
            data: Its state.
            body: Body that carries the mount.
            mount: Place and axes on it.
            rays: Directions in the mount's axes; any length. Shape (n, 3).
        """
        self._model, self._data = model, data
        self._body = model.body(body).id
        self._mount = mount
        lengths = np.linalg.norm(rays, axis=1)
        self._rays = rays / lengths[:, None]
        self.along = 1.0 / lengths  # depth along the axis per distance
        count = len(rays)
        self.geoms = np.zeros(count, dtype=np.int32)
        self.distances = np.zeros(count)
        self.normals = np.zeros((count, 3))
        self.directions = self._rays
        self.origin = np.zeros(3)

    def cast(self, cutoff: float) -> None:
        """Cast all rays as far as ``cutoff``, in [m]; misses are -1."""
        data = self._data
        axes = data.xmat[self._body].reshape(3, 3)
        self.origin = data.xpos[self._body] + axes @ self._mount.place
        turned = self._rays @ (axes @ self._mount.axes).T
        self.directions = turned
        mujoco.mj_multiRay(
            self._model,
            data,
            self.origin,
            turned.reshape(-1),
            SEEN,
            True,
            self._body,
            self.geoms,
            self.distances,
            self.normals.reshape(-1),
            len(turned),
            cutoff,
        )

    @property
    def slants(self) -> Array:
        """Cosine between each ray and the surface it hits. Shape (n,)."""
        slants: Array = np.abs(
            np.einsum("ij,ij->i", self.directions, self.normals)
        )
        return slants


class DepthCaster:
    """A depth camera with the faults of a structured-light one."""

    def __init__(
        self,
        caster: RayCaster,
        camera: CameraModel,
        settings: DepthSettings,
        generator: np.random.Generator,
    ) -> None:
        """Take images of a camera through its rays."""
        self._caster, self._camera = caster, camera
        self._settings, self._generator = settings, generator

    def take(self) -> Depths:
        """Take an image: depths in [m], 0 where nothing came back."""
        caster, settings = self._caster, self._settings
        caster.cast(2.0 * settings.far)
        hit = caster.distances > 0.0
        depth = caster.distances * caster.along
        square = depth**2
        draw = self._generator.standard_normal(depth.size)
        depth = depth + settings.noise * square * draw
        quantum = settings.step * square + 1e-6
        depth = np.round(depth / quantum) * quantum
        lost = self._generator.random(depth.size) < settings.missing
        lost |= ~hit | (caster.slants < SLANT)
        lost |= (depth < settings.near) | (depth > settings.far)
        depth[lost] = 0.0
        shape = self._camera.height, self._camera.width
        image: Depths = depth.reshape(shape).astype(np.float32)
        image[_edges(image)] = 0.0
        return image


def _edges(image: Depths) -> np.ndarray:
    """Pixels in the shadow of a nearer neighbour: the projector's parallax.

    The projector sits to the right: what is left of a near edge is dark.
    """
    edge = np.zeros(image.shape, dtype=bool)
    jump = image[:, :-1] - image[:, 1:]
    edge[:, :-1] = (jump > 0.3) & (image[:, 1:] > 0.0)
    return edge


class ColourCaster:
    """A colour camera where no graphics are: flat colours, one light."""

    def __init__(
        self, model: mujoco.MjModel, caster: RayCaster, camera: CameraModel
    ) -> None:
        """Take images of a camera through its rays."""
        self._caster, self._camera = caster, camera
        colours = model.geom_rgba[:, :3].copy()
        worn = model.geom_matid >= 0
        colours[worn] = model.mat_rgba[model.geom_matid[worn], :3]
        self._colours = colours
        self._floor = model.geom("floor").id
        walls = [i for i in range(model.ngeom) if "wall" in model.geom(i).name]
        self._colours[walls] = (0.74, 0.75, 0.73)

    def take(self) -> Pixels:
        """Take an image. Shape (height, width, 3)."""
        caster = self._caster
        caster.cast(40.0)
        geoms = caster.geoms
        colours = np.where(
            (geoms >= 0)[:, None], self._colours[geoms], SKY[None]
        )
        floor = geoms == self._floor
        points = (
            caster.origin[:2]
            + caster.distances[floor, None] * caster.directions[floor, :2]
        )
        dark = np.floor(points / TILE).astype(int).sum(axis=1) % 2
        colours[floor] = (0.86 - 0.06 * dark)[:, None] * np.array(
            [1.0, 1.0, 0.98]
        )
        light = AMBIENT + DIFFUSE * np.maximum(caster.normals @ SUN, 0.0)
        light[geoms < 0] = 1.0
        colours = colours * light[:, None] * 255.0
        shape = self._camera.height, self._camera.width, 3
        pixels: Pixels = np.clip(colours, 0.0, 255.0).astype(np.uint8)
        return pixels.reshape(shape)


class SonarCaster:
    """A sonar: the nearest thing in a cone that faces it well enough."""

    def __init__(
        self,
        caster: RayCaster,
        settings: SonarSettings,
        generator: np.random.Generator,
    ) -> None:
        """Listen through the rays of a cone."""
        self._caster, self._settings = caster, settings
        self._generator = generator

    def listen(self) -> float | None:
        """Distance of the nearest echo, in [m]; None if all is silent."""
        settings, caster = self._settings, self._caster
        caster.cast(settings.far + 0.1)
        heard = (caster.distances > 0.0) & (caster.slants > 0.5)
        # The floor throws sound away from the robot.
        heard &= np.abs(caster.normals @ UP) < 0.9
        if not heard.any():
            return None
        distance = float(caster.distances[heard].min())
        distance += settings.noise * float(self._generator.standard_normal())
        distance = round(distance / settings.step) * settings.step
        if distance > settings.far:
            return None
        return max(distance, settings.near)


def cone(opening: float) -> Array:
    """Rays that fill a cone about x. Shape (n, 3)."""
    reach = np.tan(0.5 * opening)
    across = np.linspace(-reach, reach, CONE_RAYS)
    y, z = np.meshgrid(across, across)
    inside = np.hypot(y, z) <= reach
    return np.column_stack([np.ones(int(inside.sum())), y[inside], z[inside]])
