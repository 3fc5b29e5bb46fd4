"""A robot's cameras and sonars: when they look and when it learns."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from ..core.random_streams import named_generator
from ..perception.camera_model import CameraModel
from ..perception.images import (
    ColourImage,
    DepthImage,
    Percept,
    Pixels,
    SonarEcho,
)
from ..robots.head import HeadDescription, Mount
from .camera_settings import CameraSettings
from .offscreen_rendering import RAYCAST, OffscreenRenderer
from .ray_casting import (
    ColourCaster,
    DepthCaster,
    RayCaster,
    SonarCaster,
    cone,
)
from .room_furnishing import LOWER
from .world import World

RAYCAST_WIDTH = 160  # columns of an image made of rays, at most
Take = Callable[[float], Percept]


@dataclass(slots=True, eq=False)
class SensorStream:
    """A sensor with its clock.

    Attributes:
        take: Takes a percept at a time.
        period: Between exposures, in [s].
        latency: From exposure to arrival, in [s].
        drop: Share that never arrives.
        generator: Draws what is dropped.
        taken: Exposures so far.
        pending: Percepts on their way, with their time of arrival.
    """

    take: Take
    period: float
    latency: float
    drop: float
    generator: np.random.Generator
    taken: int
    pending: deque[tuple[float, Percept]]

    def read(self, now: float, exposed: list[Percept]) -> list[Percept]:
        """Percepts that arrive by ``now``, exposing one when it is due.

        Args:
            now: Time, in [s].
            exposed: Gets what is taken now.
        """
        if now >= self.taken * self.period - 1e-9:
            self.taken += 1
            if self.drop == 0.0 or self.generator.random() >= self.drop:
                percept = self.take(now)
                exposed.append(percept)
                self.pending.append((now + self.latency, percept))
        arrived = []
        while self.pending and self.pending[0][0] <= now + 1e-9:
            arrived.append(self.pending.popleft()[1])
        return arrived


class SensorSuite:
    """Everything that one robot perceives with.

    Attributes:
        camera: Its colour camera.
        exposed: Percepts that were taken at the last tick, which the robot
            may not have yet.
    """

    def __init__(
        self,
        world: World,
        name: str,
        torso: str,
        head: HeadDescription,
        settings: CameraSettings,
        renderer: str,
        seed: int,
        *,
        with_depth: bool,
        looks_low: Callable[[], bool] | None = None,
    ) -> None:
        """Open the eyes of a robot.

        Args:
            world: World that has it.
            name: Its name there.
            torso: Its torso body, unprefixed.
            head: Its head.
            settings: What it sees with.
            renderer: What draws colour images.
            seed: Seed of the run.
            with_depth: Whether it wears the depth camera and listens.
            looks_low: Whether the robot asks for images of the lower camera
                of its head instead of the upper one; None for one that
                never does.
        """
        self._looks_low = looks_low
        self._world, self._name = world, name
        self._settings, self._seed = settings, seed
        self._head = head
        self._screen: OffscreenRenderer | None = None
        self.exposed: list[Percept] = []
        self.camera = _size_for(renderer, settings.colour.model())
        body = f"{name}/{head.body}"
        self._streams = [self._colour(body, renderer)]
        if with_depth:
            self._streams.append(self._depth(body))
            self._streams += self._sonars(f"{name}/{torso}")

    def read(self, now: float) -> tuple[Percept, ...]:
        """Percepts that arrive at a tick."""
        arrived: list[Percept] = []
        self.exposed.clear()
        for stream in self._streams:
            arrived += stream.read(now, self.exposed)
        return tuple(arrived)

    def close(self) -> None:
        """Let go of the graphics, if there are any."""
        if self._screen is not None:
            self._screen.close()
            self._screen = None

    def _generator(self, purpose: str) -> np.random.Generator:
        return named_generator(self._seed, f"eyes/{self._name}/{purpose}")

    def _stream(
        self, purpose: str, take: Take, rate: float, latency: float
    ) -> SensorStream:
        settings = self._settings
        tick = self._world.physics.tick
        return SensorStream(
            take,
            max(1, round(1.0 / rate / tick)) * tick,
            latency + settings.added_latency,
            settings.drop_frames,
            self._generator(f"drops of {purpose}"),
            0,
            deque(),
        )

    def _colour(self, body: str, renderer: str) -> SensorStream:
        settings, camera = self._settings.colour, self.camera
        head, low = self._head, self._looks_low
        if renderer != RAYCAST:
            self._screen = OffscreenRenderer(
                self._world.model, camera.width, camera.height, renderer
            )
        upper = self._pixels(body, renderer, head.top, head.camera)
        lower = None
        if low is not None and head.bottom is not None:
            lower = self._pixels(body, renderer, head.bottom, LOWER)
        grain = ImageNoise(camera, settings.noise, self._generator("grain"))

        def take(now: float) -> Percept:
            if lower is not None and low is not None and low():
                return ColourImage(now, camera, grain.spoil(lower()), True)
            return ColourImage(now, camera, grain.spoil(upper()))

        return self._stream("colour", take, settings.rate, settings.latency)

    def _pixels(
        self, body: str, renderer: str, mount: Mount, name: str
    ) -> Callable[[], Pixels]:
        """What takes images of one camera of the head.

        Args:
            body: The head.
            renderer: What draws them.
            mount: Of the camera on the head.
            name: Of the camera in the model.
        """
        model, data, camera = self._world.model, self._world.data, self.camera
        screen = self._screen
        if screen is None:
            rays = camera.rays().reshape(-1, 3)
            caster = RayCaster(model, data, body, mount, rays)
            return ColourCaster(model, caster, camera).take
        number = model.camera(f"{self._name}/{name}").id
        vertical = 2.0 * np.arctan(0.5 * camera.height / camera.focal_y)
        model.cam_fovy[number] = np.degrees(vertical)
        return lambda: screen.draw(data, number)

    def _depth(self, body: str) -> SensorStream:
        world, settings = self._world, self._settings.depth
        camera = settings.model()
        rays = camera.rays().reshape(-1, 3)
        mount = self._head.depth
        caster = RayCaster(world.model, world.data, body, mount, rays)
        generator = self._generator("depth")
        eye = DepthCaster(caster, camera, settings, generator)

        def take(now: float) -> Percept:
            return DepthImage(
                now, camera, eye.take(), settings.near, settings.far
            )

        return self._stream("depth", take, settings.rate, settings.latency)

    def _sonars(self, torso: str) -> list[SensorStream]:
        world, settings = self._world, self._settings.sonar
        streams = []
        for key, mount in self._head.sonars.items():
            rays = cone(settings.cone)
            caster = RayCaster(world.model, world.data, torso, mount, rays)
            generator = self._generator(f"sonar {key}")
            ear = SonarCaster(caster, settings, generator)

            def take(
                now: float, key: str = key, ear: SonarCaster = ear
            ) -> Percept:
                return SonarEcho(now, key, ear.listen())

            streams.append(
                self._stream(f"sonar {key}", take, settings.rate, 0.0)
            )
        return streams


class ImageNoise:
    """Noise of pixels: one tile of it, shifted at random for each image."""

    def __init__(
        self,
        camera: CameraModel,
        deviation: float,
        generator: np.random.Generator,
    ) -> None:
        """Draw the tile."""
        self._generator = generator
        self._height, self._width = camera.height, camera.width
        shape = 2 * camera.height, 2 * camera.width, 3
        tile = np.rint(deviation * generator.standard_normal(shape))
        self._tile = tile.astype(np.int16)

    def spoil(self, pixels: Pixels) -> Pixels:
        """Add noise to an image. Shape (height, width, 3)."""
        row = int(self._generator.integers(self._height))
        column = int(self._generator.integers(self._width))
        noise = self._tile[
            row : row + self._height, column : column + self._width
        ]
        spoilt = cv2.add(pixels, noise, dtype=cv2.CV_8U)
        return np.asarray(spoilt, dtype=np.uint8)


def _size_for(renderer: str, camera: CameraModel) -> CameraModel:
    """Camera at the size that a renderer can afford."""
    if renderer != RAYCAST or camera.width <= RAYCAST_WIDTH:
        return camera
    share = RAYCAST_WIDTH / camera.width
    return CameraModel(
        RAYCAST_WIDTH,
        round(camera.height * share),
        camera.focal_x * share,
        camera.focal_y * share,
    )
