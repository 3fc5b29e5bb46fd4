"""Cameras and sonars by ray casting, without graphics."""

import mujoco
import numpy as np

from ..core.poses import Array
from ..perception.camera_model import CameraModel
from ..perception.images import Depths, Pixels
from ..robots.head import Mount
from .camera_settings import DepthSettings, SonarSettings
from .view_cone import geoms_in_cone

VISIBLE = np.array([1, 1, 1, 0, 0, 0], dtype=np.uint8)  # geom groups
SKY = np.array([0.78, 0.84, 0.90])
SUN = np.array([-0.2, -0.3, 1.0]) / np.sqrt(1.13)  # direction to the light
AMBIENT, DIFFUSE = 0.55, 0.45
TILE = 0.5  # side of a square of the floor, in [m]
MIN_COSINE = 0.12  # of the incidence angle for a return to depth cameras
MIN_COSINE_SONAR = 0.5  # of the incidence angle for an echo
# MuJoCo drops a plane whose origin is beyond the cutoff: a floor would vanish
# before robots far from the origin of the world.
UNLIMITED = 1e10  # cutoff, in [m]
CONE_RAYS = 6  # across the cone of a sonar
UP = np.array([0.0, 0.0, 1.0])


class RayCaster:
    """Ray caster from a mount on a body, which the rays ignore.

    Attributes:
        along: Depth along the mount axis per distance. Shape (n,).
        geoms: Indices of the geoms hit; -1 for none. Shape (n,).
        distances: Distances to the hits, in [m]; -1 for none. Shape (n,).
        normals: Surface normals in the world. Shape (n, 3).
        directions: Ray directions in the world. Shape (n, 3).
        origin: Origin of the rays in the world, in [m]. Shape (3,).
    """

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
            model: Model of the world.
            data: Its state.
            body: Name of the body that carries the mount.
            mount: Position and axes on that body.
            rays: Directions in the mount frame, of any length. Shape (n, 3).
        """
        self._model, self._data = model, data
        self._body = model.body(body).id
        self._mount = mount
        lengths = np.linalg.norm(rays, axis=1)
        self._rays = rays / lengths[:, None]
        self.along = 1.0 / lengths
        self._half_angle = float(np.arccos(self._rays[:, 0].min()))
        count = len(rays)
        self.geoms = np.zeros(count, dtype=np.int32)
        self.distances = np.zeros(count)
        self.normals = np.zeros((count, 3))
        self.directions = self._rays
        self.origin = np.zeros(3)

    def cast(self, cutoff: float) -> None:
        """Cast all rays up to a distance, in [m]; misses are -1."""
        data = self._data
        axes = data.xmat[self._body].reshape(3, 3)
        self.origin = (
            data.xpos[self._body] + axes @ self._mount.position_in_body
        )
        axes_in_world = axes @ self._mount.axes_in_body
        self.directions = self._rays @ axes_in_world.T
        with geoms_in_cone(
            self._model,
            data,
            self.origin,
            axes_in_world[:, 0],
            self._half_angle,
        ):
            mujoco.mj_multiRay(
                self._model,
                data,
                self.origin,
                self.directions.reshape(-1),
                VISIBLE,
                True,
                self._body,
                self.geoms,
                self.distances,
                self.normals.reshape(-1),
                len(self.directions),
                cutoff,
            )

    @property
    def slants(self) -> Array:
        """Cosines of the angles of incidence. Shape (n,)."""
        slants: Array = np.abs(
            np.einsum("ij,ij->i", self.directions, self.normals)
        )
        return slants


class DepthCaster:
    """Depth camera with the errors of structured light."""

    def __init__(
        self,
        caster: RayCaster,
        camera: CameraModel,
        settings: DepthSettings,
        generator: np.random.Generator,
    ) -> None:
        """Use the rays of a camera."""
        self._caster, self._camera = caster, camera
        self._settings, self._generator = settings, generator

    def take(self) -> Depths:
        """Return a depth image, in [m]; 0 without return."""
        caster, settings = self._caster, self._settings
        caster.cast(UNLIMITED)
        hit = caster.distances > 0.0
        depth = caster.distances * caster.along
        squared = depth**2
        draw = self._generator.standard_normal(depth.size)
        depth = depth + settings.noise * squared * draw
        quantum = settings.step * squared + 1e-6
        depth = np.round(depth / quantum) * quantum
        missing = self._generator.random(depth.size) < settings.missing
        missing |= ~hit | (caster.slants < MIN_COSINE)
        missing |= (depth < settings.near) | (depth > settings.far)
        depth[missing] = 0.0
        shape = self._camera.height, self._camera.width
        image: Depths = depth.reshape(shape).astype(np.float32)
        image[_edges(image)] = 0.0
        return image


def _edges(image: Depths) -> np.ndarray:
    """Return pixels in the shadow of a nearer neighbour.

    The projector is to the right of the camera, so the pixels left of a near
    edge have no return.
    """
    edge = np.zeros(image.shape, dtype=bool)
    jump = image[:, :-1] - image[:, 1:]
    edge[:, :-1] = (jump > 0.3) & (image[:, 1:] > 0.0)
    return edge


class ColourCaster:
    """Colour camera with flat colours and one light."""

    def __init__(
        self, model: mujoco.MjModel, caster: RayCaster, camera: CameraModel
    ) -> None:
        """Use the rays of a camera."""
        self._caster, self._camera = caster, camera
        colours = model.geom_rgba[:, :3].copy()
        has_material = model.geom_matid >= 0
        colours[has_material] = model.mat_rgba[
            model.geom_matid[has_material], :3
        ]
        self._colours = colours
        self._floor = model.geom("floor").id
        walls = [i for i in range(model.ngeom) if "wall" in model.geom(i).name]
        self._colours[walls] = (0.74, 0.75, 0.73)

    def take(self) -> Pixels:
        """Return a colour image. Shape (height, width, 3)."""
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
    """Sonar: distance of the nearest surface in a cone that faces it."""

    def __init__(
        self,
        caster: RayCaster,
        settings: SonarSettings,
        generator: np.random.Generator,
    ) -> None:
        """Use the rays of a cone."""
        self._caster, self._settings = caster, settings
        self._generator = generator

    def listen(self) -> float | None:
        """Return the distance of the nearest echo, in [m]; None without."""
        settings, caster = self._settings, self._caster
        caster.cast(settings.far + 0.1)
        echoes = (caster.distances > 0.0) & (caster.slants > MIN_COSINE_SONAR)
        # The floor reflects sound away from the robot.
        echoes &= np.abs(caster.normals @ UP) < 0.9
        if not echoes.any():
            return None
        distance = float(caster.distances[echoes].min())
        distance += settings.noise * float(self._generator.standard_normal())
        distance = round(distance / settings.step) * settings.step
        if distance > settings.far:
            return None
        return max(distance, settings.near)


def cone(opening: float) -> Array:
    """Return rays that fill a cone about x. Shape (n, 3)."""
    reach = np.tan(0.5 * opening)
    across = np.linspace(-reach, reach, CONE_RAYS)
    y, z = np.meshgrid(across, across)
    inside = np.hypot(y, z) <= reach
    return np.column_stack([np.ones(int(inside.sum())), y[inside], z[inside]])
