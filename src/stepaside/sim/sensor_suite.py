"""Simulated cameras and sonars of a robot, with rates and latencies."""

from collections.abc import Callable
from math import atan, hypot

import cv2
import numpy as np

from ..core.poses import Array
from ..core.random_streams import named_generator
from ..perception.camera_model import CameraModel
from ..perception.images import (
    ColourImage,
    DepthImage,
    Percept,
    Pixels,
    SonarEcho,
)
from ..robots.description import RobotDescription
from ..robots.head import Mount, load_head
from .camera_settings import CameraSettings
from .offscreen_rendering import OffscreenRenderer
from .ray_casting import (
    ColourCaster,
    DepthCaster,
    RayCaster,
    SonarCaster,
    cone,
)
from .sensor_stream import SensorStream, StreamedSensors, period_of
from .view_cone import geoms_in_cone
from .world import World

RAYCAST_WIDTH = 160  # largest width of a ray-cast image, in [pixels]


class SensorSuite(StreamedSensors[Percept]):
    """All cameras and sonars of one robot.

    Attributes:
        camera: Model of its colour camera.
    """

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
        """Create the sensors of a robot.

        Args:
            world: World with the robot.
            name: Name of the robot in the world.
            description: Description of the robot, which has a head.
            settings: Settings of the sensors.
            renderer: Renderer of colour images, which robots may share; None
                for ray casting.
            seed: Seed of the run.
            with_depth: Whether it has a depth camera and sonars.
        """
        self._world, self._name = world, name
        self._settings, self._seed = settings, seed
        self._head = load_head(description)
        self._renderer = renderer
        camera = settings.colour.model()
        self.camera = _reduced(camera) if renderer is None else camera
        streams = [self._colour()]
        if with_depth:
            used = self._head.depth_mounts(rear=settings.rear_camera)
            streams += map(self._depth, range(len(used)), used)
            streams += self._sonars()
        super().__init__(streams)

    def close(self) -> None:
        """Release the graphics context, if any."""
        if self._renderer is not None:
            self._renderer.close()

    def _caster(self, mount: Mount, rays: Array) -> RayCaster:
        """Return a caster of rays in the frame of a mount. Shape (n, 3)."""
        body = f"{self._name}/{self._head.body_of(mount)}"
        return RayCaster(
            self._world.model, self._world.data, body, mount, rays
        )

    def _generator(self, purpose: str) -> np.random.Generator:
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
        """Return the function that takes images of one camera of the head.

        Args:
            mount: Mount of the camera on the head.
            name: Name of the camera in the model.
        """
        model, data, camera = self._world.model, self._world.data, self.camera
        screen = self._renderer
        if screen is None:
            caster = self._caster(mount, camera.rays().reshape(-1, 3))
            return ColourCaster(model, caster, camera).take
        number = model.camera(f"{self._name}/{name}").id
        vertical = 2.0 * np.arctan(0.5 * camera.height / camera.focal_y)
        model.cam_fovy[number] = np.degrees(vertical)
        # Graphics use the vertical focal length in both directions.
        focal = min(camera.focal_x, camera.focal_y)
        half_angle = atan(0.5 * hypot(camera.width, camera.height) / focal)

        def draw() -> Pixels:
            axis = -data.cam_xmat[number].reshape(3, 3)[:, 2]
            position = data.cam_xpos[number]
            with geoms_in_cone(model, data, position, axis, half_angle):
                return screen.draw(data, number)

        return draw

    def _depth(self, number: int, mount: Mount) -> SensorStream[Percept]:
        """Return the stream of a depth camera."""
        settings = self._settings.depth_of(mount)
        camera, name = settings.model(), f"depth {number}".removesuffix(" 0")
        caster = self._caster(mount, camera.rays().reshape(-1, 3))
        generator = self._generator(name)
        depth_caster = DepthCaster(caster, camera, settings, generator)
        near, far = settings.near, settings.far

        def take(now: float) -> Percept:
            return DepthImage(
                now, camera, depth_caster.take(), near, far, number
            )

        return self._stream(name, take, settings.rate, settings.latency)

    def _sonars(self) -> list[SensorStream[Percept]]:
        settings = self._settings.sonar
        streams = []
        for key, mount in self._head.sonars.items():
            caster = self._caster(mount, cone(settings.cone))
            generator = self._generator(f"sonar {key}")
            sonar_caster = SonarCaster(caster, settings, generator)

            def take(
                now: float,
                key: str = key,
                sonar_caster: SonarCaster = sonar_caster,
            ) -> Percept:
                return SonarEcho(now, key, sonar_caster.listen())

            streams.append(
                self._stream(f"sonar {key}", take, settings.rate, 0.0)
            )
        return streams


class ImageNoise:
    """Pixel noise: one tile of noise, shifted at random for each image."""

    def __init__(
        self,
        camera: CameraModel,
        deviation: float,
        generator: np.random.Generator,
    ) -> None:
        """Generate the tile."""
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
    if camera.width <= RAYCAST_WIDTH:
        return camera
    scale = RAYCAST_WIDTH / camera.width
    return CameraModel(
        RAYCAST_WIDTH,
        round(camera.height * scale),
        camera.focal_x * scale,
        camera.focal_y * scale,
    )
