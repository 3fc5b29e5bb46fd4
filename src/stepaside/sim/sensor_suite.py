"""Simulated cameras of a robot, with rates and latencies."""

from collections.abc import Callable

import cv2
import mujoco
import numpy as np

from ..core.poses import Array
from ..core.random_streams import named_generator
from ..perception.camera_model import CameraModel
from ..perception.images import (
    ColourImage,
    DepthImage,
    Depths,
    Percept,
    Pixels,
)
from ..robots.description import RobotDescription
from ..robots.head import Mount, load_head
from .camera_settings import CameraSettings, DepthSettings
from .offscreen_rendering import OffscreenRenderer
from .ranging import (
    RayCaster,
    SensorStream,
    StreamedSensors,
    period_of,
)
from .world import World

RAYCAST_WIDTH = 160  # largest width of a ray-cast image, in [pixels]
SKY = np.array([0.78, 0.84, 0.90])
WALL = 0.74, 0.75, 0.73
SUN = np.array([-0.2, -0.3, 1.0]) / np.sqrt(1.13)  # direction to the light
AMBIENT, DIFFUSE = 0.55, 0.45
TILE = 0.5  # side of a square of the floor, in [m]
FARTHEST = 40.0  # that a ray-cast image shows, in [m]
MIN_COSINE = 0.12  # of the incidence angle for a return to depth cameras
Generator = np.random.Generator


class SensorSuite(StreamedSensors[Percept]):
    """All cameras of one robot."""

    def __init__(
        self,
        world: World,
        name: str,
        description: RobotDescription,
        settings: CameraSettings,
        renderer: OffscreenRenderer | None,
        seed: int,
        *,
        with_depth: bool,
    ) -> None:
        """Create the sensors; robots may share the renderer, None for rays."""
        self._world, self._name = world, name
        self._settings, self._seed = settings, seed
        self._head = load_head(description)
        self._renderer = renderer
        own = settings.colour
        camera = CameraModel.of_field_of_view(own.width, own.height, *own.view)
        self.camera = _reduced(camera) if renderer is None else camera
        streams = [self._colour()]
        if with_depth:
            used = self._head.depth_mounts(rear=settings.rear_camera)
            streams += map(self._depth, range(len(used)), used)
        super().__init__(streams)

    def close(self) -> None:
        """Release the graphics context, if any."""
        if self._renderer is not None:
            self._renderer.close()

    def _caster(self, mount: Mount, rays: Array) -> RayCaster:
        body = f"{self._name}/{self._head.body_of(mount)}"
        world, rays = self._world, rays.reshape(-1, 3)
        return RayCaster(world.model, world.data, body, mount, rays)

    def _generator(self, purpose: str) -> Generator:
        return named_generator(self._seed, f"eyes/{self._name}/{purpose}")

    def _stream(
        self,
        purpose: str,
        take: Callable[[float], Percept],
        rate: float,
        latency: float,
    ) -> SensorStream[Percept]:
        settings = self._settings
        return SensorStream(
            take,
            period_of(rate, self._world.physics.tick),
            latency + settings.added_latency,
            settings.drop_frames,
            self._generator(f"drops of {purpose}"),
        )

    def _colour(self) -> SensorStream[Percept]:
        settings, camera = self._settings.colour, self.camera
        draw = self._pixels(self._head.top, self._head.camera)
        noise = ImageNoise(camera, settings.noise, self._generator("grain"))

        def take(now: float) -> Percept:
            return ColourImage(now, camera, noise.add_to(draw()))

        return self._stream("colour", take, settings.rate, settings.latency)

    def _pixels(self, mount: Mount, name: str) -> Callable[[], Pixels]:
        """Return the function that takes images of a camera of the model."""
        model, data, camera = self._world.model, self._world.data, self.camera
        screen = self._renderer
        if screen is None:
            return colour_caster(
                model, self._caster(mount, camera.rays()), camera
            )
        number = model.camera(f"{self._name}/{name}").id
        vertical = 2.0 * np.arctan(0.5 * camera.height / camera.focal_y)
        model.cam_fovy[number] = np.degrees(vertical)
        return lambda: screen.draw(data, number)

    def _depth(self, number: int, mount: Mount) -> SensorStream[Percept]:
        own = self._settings.depth
        if mount.on_torso:
            own = self._settings.rear
        camera = CameraModel.of_field_of_view(own.width, own.height, *own.view)
        name = f"depth {number}".removesuffix(" 0")
        caster = self._caster(mount, camera.rays())
        generator = self._generator(name)

        def take(now: float) -> Percept:
            depths = cast_depths(caster, camera, own, generator)
            return DepthImage(now, camera, depths, own.near, own.far, number)

        return self._stream(name, take, own.rate, own.latency)


def cast_depths(
    caster: RayCaster,
    camera: CameraModel,
    settings: DepthSettings,
    generator: Generator,
) -> Depths:
    """Return depths [m] with errors of structured light; 0 is no return."""
    caster.cast()
    hit = caster.distances > 0.0
    depth = caster.distances * caster.along
    squared = depth**2
    draw = generator.standard_normal(depth.size)
    depth = depth + settings.noise * squared * draw
    quantum = settings.step * squared + 1e-6
    depth = np.round(depth / quantum) * quantum
    missing = generator.random(depth.size) < settings.missing
    missing |= ~hit | (caster.slants < MIN_COSINE)
    missing |= (depth < settings.near) | (depth > settings.far)
    depth[missing] = 0.0
    image: Depths = depth.reshape(camera.height, camera.width).astype("f4")
    image[edges(image)] = 0.0
    return image


def edges(image: Depths) -> np.ndarray:
    """Return pixels left of a nearer one, which the projector cannot reach."""
    edge = np.zeros(image.shape, dtype=bool)
    jump = image[:, :-1] - image[:, 1:]
    edge[:, :-1] = (jump > 0.3) & (image[:, 1:] > 0.0)
    return edge


def colour_caster(
    model: mujoco.MjModel, caster: RayCaster, camera: CameraModel
) -> Callable[[], Pixels]:
    """Return the function that casts images of flat colours."""
    palette = model.geom_rgba[:, :3].copy()
    coated = model.geom_matid >= 0
    palette[coated] = model.mat_rgba[model.geom_matid[coated], :3]
    ground = model.geom("floor").id
    walls = [i for i in range(model.ngeom) if "wall" in model.geom(i).name]
    palette[walls] = WALL

    def take() -> Pixels:
        caster.cast(FARTHEST)
        geoms = caster.geoms
        colours = np.where((geoms >= 0)[:, None], palette[geoms], SKY[None])
        floor = geoms == ground
        points = (
            caster.origin[:2]
            + caster.distances[floor, None] * caster.directions[floor, :2]
        )
        dark = np.floor(points / TILE).astype(int).sum(axis=1) % 2
        colours[floor] = (0.86 - 0.06 * dark)[:, None] * (1.0, 1.0, 0.98)
        light = AMBIENT + DIFFUSE * np.maximum(caster.normals @ SUN, 0.0)
        light[geoms < 0] = 1.0
        colours = colours * light[:, None] * 255.0
        pixels: Pixels = np.clip(colours, 0.0, 255.0).astype(np.uint8)
        return pixels.reshape(camera.height, camera.width, 3)

    return take


class ImageNoise:
    """Pixel noise: one tile of noise, shifted at random for each image."""

    def __init__(
        self, camera: CameraModel, deviation: float, generator: Generator
    ) -> None:
        self._generator = generator
        self._height, self._width = camera.height, camera.width
        shape = 2 * camera.height, 2 * camera.width, 3
        tile = np.rint(deviation * generator.standard_normal(shape))
        self._brighter = np.clip(tile, 0.0, 255.0).astype(np.uint8)
        self._darker = np.clip(-tile, 0.0, 255.0).astype(np.uint8)

    def add_to(self, pixels: Pixels) -> Pixels:
        """Add noise to an image. Shape (height, width, 3)."""
        row = int(self._generator.integers(self._height))
        column = int(self._generator.integers(self._width))
        area = np.s_[row : row + self._height, column : column + self._width]
        noisy = cv2.add(pixels, self._brighter[area])
        noisy = cv2.subtract(noisy, self._darker[area])
        return np.asarray(noisy, dtype=np.uint8)


def _reduced(camera: CameraModel) -> CameraModel:
    """Return the camera model with fewer pixels, for ray casting."""
    scale = min(1.0, RAYCAST_WIDTH / camera.width)
    return CameraModel(
        round(camera.width * scale),
        round(camera.height * scale),
        camera.focal_x * scale,
        camera.focal_y * scale,
    )
