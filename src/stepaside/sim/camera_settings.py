"""Settings of cameras and sonars, and of the scene around the robots."""

from dataclasses import dataclass, field
from math import radians
from typing import ClassVar

from ..arena import Room
from ..core.errors import ConfigurationError, check_within
from ..core.ranges import Range, Ranges, check_count, check_settings
from ..perception.camera_model import CameraModel

PIXELS = Range(
    8,
    4096,
    "pixels",
    "too few to detect anything; more do not fit in memory",
    whole=True,
)
RATE = Range(1.0, 60.0, "1/s", "typical of such sensors")
LATENCY = Range(0.0, 1.0, "s", "how long a robot stores its poses")
QUANTUM = Range(1e-6, 1.0, "m", "from below the noise to useless")
MAX_OBJECTS = 100  # in a room
KINDS = ("red box", "blue box", "white figure")
# Horizontal and vertical field of view of NAO's top camera, in [deg].
OPTICS = {"v5": (60.9, 47.6), "v6": (54.7, 42.5)}
BACKENDS = ("egl", "osmesa")  # off-screen graphics
RAYCAST = "raycast"  # without graphics
RENDERERS = ("auto", *BACKENDS, RAYCAST)


@dataclass(frozen=True, slots=True)
class ColourSettings:
    """Settings of NAO's top camera.

    Attributes:
        optics: "v5" or "v6".
        width: Image width, in [pixels]; the V6 offers 320 and more, both
            offer 160; 8 to 4096.
        height: Image height, in [pixels]; 8 to 4096.
        rate: Frame rate, in [1/s]; the sensor gives up to 30; 1 to 60.
        latency: Delay from exposure to arrival, in [s]; 0 to 1.
        noise: Standard deviation of a pixel, of 255; 0 to 64.
        renderer: One of ``RENDERERS``.
    """

    optics: str = "v5"
    width: int = 320
    height: int = 240
    rate: float = 15.0
    latency: float = 0.05
    noise: float = 4.0
    renderer: str = "auto"

    ranges: ClassVar[Ranges] = {
        "width": PIXELS,
        "height": PIXELS,
        "rate": RATE,
        "latency": LATENCY,
        "noise": Range(0.0, 64.0, "1", "a quarter of all levels"),
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)
        if self.optics not in OPTICS:
            raise ConfigurationError(
                f"optics must be one of {', '.join(OPTICS)}, "
                f"got {self.optics!r}"
            )

    def model(self) -> CameraModel:
        """Return the camera model with these optics."""
        across, down = (radians(a) for a in OPTICS[self.optics])
        size = self.width, self.height
        return CameraModel.of_field_of_view(*size, across, down)


@dataclass(frozen=True, slots=True)
class DepthSettings:
    """Settings of the ASUS Xtion on the evader's head.

    Attributes:
        width: Columns that are used, of 640; 8 to 4096.
        height: Rows that are used, of 480; 8 to 4096.
        rate: Frame rate, in [1/s]; the sensor gives 30; 1 to 60.
        latency: Delay from exposure to arrival, in [s]; 0 to 1.
        near: Lower limit of the range, in [m]; 0.01 to 20.
        far: Upper limit of the range, in [m]; 0.01 to 20.
        noise: Standard deviation at 1 m, in [m]; proportional to the squared
            distance; 0 to 1.
        step: Quantum at 1 m, in [m]; proportional to the squared distance;
            1e-06 to 1.
        missing: Fraction of the pixels without return; 0 to 1.
    """

    width: int = 80
    height: int = 60
    rate: float = 15.0
    latency: float = 0.05
    near: float = 0.8
    far: float = 3.5
    noise: float = 0.0019
    step: float = 0.00285
    missing: float = 0.02

    ranges: ClassVar[Ranges] = {
        "width": PIXELS,
        "height": PIXELS,
        "rate": RATE,
        "latency": LATENCY,
        "near": Range(0.01, 20.0, "m", "the size of a lens"),
        "far": Range(0.01, 20.0, "m", "from near to the size of a room"),
        "noise": Range(0.0, 1.0, "m", "more is no measurement"),
        "step": QUANTUM,
        "missing": Range(0.0, 1.0, "1", "a fraction"),
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)
        check_within(self.far, self.near, 20.0, "far", "m", ConfigurationError)

    def model(self) -> CameraModel:
        """Return the camera model with the optics of the Xtion."""
        return CameraModel.of_field_of_view(
            self.width, self.height, radians(58.0), radians(45.0)
        )


@dataclass(frozen=True, slots=True)
class SonarSettings:
    """Settings of NAO's sonars, V5 and V6.

    Attributes:
        rate: Echo rate of each, in [1/s]; assumed; 1 to 40.
        near: Lower limit of the range; nearer objects read as this, in [m];
            0.01 to 10.
        far: Upper limit of the range; farther objects give no echo, in [m];
            0.01 to 10.
        cone: Opening angle, in [rad]; 0.05 to 2.5.
        noise: Standard deviation, in [m]; 0 to 1.
        step: Quantum, in [m]; 1e-06 to 1.
    """

    rate: float = 10.0
    near: float = 0.2
    far: float = 0.8
    cone: float = radians(60.0)
    noise: float = 0.01
    step: float = 0.01

    ranges: ClassVar[Ranges] = {
        "rate": Range(1.0, 40.0, "1/s", "echoes must not overlap"),
        "near": Range(0.01, 10.0, "m", "the surface of the chest"),
        "far": Range(0.01, 10.0, "m", "from near to the longest echo"),
        "cone": Range(0.05, 2.5, "rad", "from a ray to half the room"),
        "noise": Range(0.0, 1.0, "m", "more is no measurement"),
        "step": QUANTUM,
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)
        check_within(self.far, self.near, 10.0, "far", "m", ConfigurationError)


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """Settings of all exteroceptive sensors of the robots.

    Attributes:
        colour: The camera in the head of either robot.
        depth: The depth camera on the evader's head.
        sonar: The sonars in the evader's chest.
        drop_frames: Fraction of the images that are lost; 0 to 1.
        added_latency: Additional latency of each camera, in [s]; 0 to 0.5.
    """

    colour: ColourSettings = field(default_factory=ColourSettings)
    depth: DepthSettings = field(default_factory=DepthSettings)
    sonar: SonarSettings = field(default_factory=SonarSettings)
    drop_frames: float = 0.0
    added_latency: float = 0.0

    ranges: ClassVar[Ranges] = {
        "drop_frames": Range(0.0, 1.0, "1", "a fraction"),
        "added_latency": Range(
            0.0, 0.5, "s", "in addition to a camera's latency"
        ),
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)


@dataclass(frozen=True, slots=True)
class RoomObject:
    """Object in the room.

    Attributes:
        kind: "red box", "blue box" or "white figure".
        x: Position, x in the world, in [m]; -20 to 20.
        y: Position, y in the world, in [m]; -20 to 20.
    """

    kind: str
    x: float
    y: float

    ranges: ClassVar[Ranges] = {
        "x": Range(-20.0, 20.0, "m", "beyond, outside any room"),
        "y": Range(-20.0, 20.0, "m", "beyond, outside any room"),
    }

    def __post_init__(self) -> None:
        """Check the kind and the ranges."""
        if self.kind not in KINDS:
            raise ConfigurationError(
                f"an object must be one of {', '.join(KINDS)}, got "
                f"{self.kind!r}"
            )
        check_settings(self, prefix=f"{self.kind} ")


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """Walls, objects and floor plan around the robots.

    Attributes:
        walls: Distance from the origin to the walls that cameras see, in [m];
            if a player starts beyond, or less than 1 m inside, they are moved
            to 3.5 m beyond that player; 0 for none; 2 to 20 or 0.
        things: Objects.
        plan: Floor plan of the room of the game, with any kind of sensing;
            None for an open floor.
    """

    walls: float = 5.0
    things: list[RoomObject] = field(default_factory=list)
    plan: Room | None = None

    ranges: ClassVar[Ranges] = {
        "walls": Range(
            2.0,
            20.0,
            "m",
            "nearer, no way past them; farther, out of sight",
            also=(0.0,),
        ),
    }

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)
        check_count(self.things, MAX_OBJECTS, "things")


# Outside the path of a duel, but in view of both robots.
CLUTTER = (
    RoomObject("red box", 3.4, 1.6),
    RoomObject("blue box", -1.6, -2.0),
    RoomObject("white figure", 3.2, -1.8),
)
