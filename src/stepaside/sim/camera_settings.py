"""Settings of what the robots see with, and of the room around them."""

from dataclasses import dataclass, field
from math import radians
from typing import ClassVar

from ..arena import Room
from ..core.errors import ConfigurationError, check_within
from ..core.ranges import Range, Ranges, check_count, check_settings
from ..perception.camera_model import CameraModel

PIXELS = Range(
    *(8, 4096, "pixels"),
    "nothing is seen in fewer; more do not fit in memory",
    whole=True,
)
RATE = Range(1.0, 60.0, "1/s", "what such sensors give")
LATENCY = Range(0.0, 1.0, "s", "what a robot remembers of its way")
QUANTUM = Range(1e-6, 1.0, "m", "from finer than any noise to useless")
MOST_THINGS = 100  # in a room
KINDS = ("red box", "blue box", "white figure")
# Horizontal and vertical field of view of NAO's top camera, in [deg].
OPTICS = {"v5": (60.9, 47.6), "v6": (54.7, 42.5)}
BACKENDS = ("egl", "osmesa")  # of graphics without a screen
RAYCAST = "raycast"  # no graphics at all
RENDERERS = ("auto", *BACKENDS, RAYCAST)


@dataclass(frozen=True, slots=True)
class ColourSettings:
    """NAO's top camera.

    Attributes:
        optics: "v5" or "v6".
        width: Columns; the V6 offers 320 and more, both offer 160; 8 to 4096.
        height: Rows; 8 to 4096.
        rate: Images per second, in [1/s]; the sensor gives up to 30; 1 to 60.
        latency: From exposure to the image in hand, in [s]; 0 to 1.
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
        """Refuse what no such camera is."""
        check_settings(self)
        if self.optics not in OPTICS:
            raise ConfigurationError(
                f"optics must be one of {', '.join(OPTICS)}, "
                f"got {self.optics!r}"
            )

    def model(self) -> CameraModel:
        """Pinhole camera with these optics."""
        across, down = (radians(a) for a in OPTICS[self.optics])
        size = self.width, self.height
        return CameraModel.of_field_of_view(*size, across, down)


@dataclass(frozen=True, slots=True)
class DepthSettings:
    """The ASUS Xtion on the evader's head.

    Attributes:
        width: Columns that are used, of 640; 8 to 4096.
        height: Rows that are used, of 480; 8 to 4096.
        rate: Images per second, in [1/s]; the sensor gives 30; 1 to 60.
        latency: From exposure to the image in hand, in [s]; 0 to 1.
        near: Nothing nearer comes back, in [m]; 0.01 to 20.
        far: Nothing farther comes back, in [m]; 0.01 to 20.
        noise: Standard deviation at 1 m, in [m]; it grows with the square; 0
            to 1.
        step: Quantum at 1 m, in [m]; it grows with the square; 1e-06 to 1.
        missing: Share of the pixels that nothing comes back to; 0 to 1.
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
        "near": Range(0.01, 20.0, "m", "nothing is nearer to a lens"),
        "far": Range(0.01, 20.0, "m", "from near on, as far as a room goes"),
        "noise": Range(0.0, 1.0, "m", "more is no distance at all"),
        "step": QUANTUM,
        "missing": Range(0.0, 1.0, "1", "a share"),
    }

    def __post_init__(self) -> None:
        """Refuse what no such camera is."""
        check_settings(self)
        check_within(self.far, self.near, 20.0, "far", "m", ConfigurationError)

    def model(self) -> CameraModel:
        """Pinhole camera with the optics of the Xtion."""
        return CameraModel.of_field_of_view(
            self.width, self.height, radians(58.0), radians(45.0)
        )


@dataclass(frozen=True, slots=True)
class SonarSettings:
    """NAO's sonars, V5 and V6.

    Attributes:
        rate: Echoes per second of each, in [1/s]; assumed; 1 to 40.
        near: Nearer things sound as near as this, in [m]; 0.01 to 10.
        far: Farther things are not heard, in [m]; 0.01 to 10.
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
        "rate": Range(1.0, 40.0, "1/s", "the next echo waits for the last"),
        "near": Range(0.01, 10.0, "m", "nothing is nearer to the chest"),
        "far": Range(0.01, 10.0, "m", "from near on, as far as echoes come"),
        "cone": Range(0.05, 2.5, "rad", "from a ray to half the room"),
        "noise": Range(0.0, 1.0, "m", "more is no distance at all"),
        "step": QUANTUM,
    }

    def __post_init__(self) -> None:
        """Refuse what no sonar is."""
        check_settings(self)
        check_within(self.far, self.near, 10.0, "far", "m", ConfigurationError)


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """Everything that a robot perceives the other with.

    Attributes:
        colour: The camera in the head of either robot.
        depth: The depth camera on the evader's head.
        sonar: The sonars in the evader's chest.
        drop_frames: Share of the images that never arrive; 0 to 1.
        added_latency: Latency on top of each camera's own, in [s]; 0 to 0.5.
    """

    colour: ColourSettings = field(default_factory=ColourSettings)
    depth: DepthSettings = field(default_factory=DepthSettings)
    sonar: SonarSettings = field(default_factory=SonarSettings)
    drop_frames: float = 0.0
    added_latency: float = 0.0

    ranges: ClassVar[Ranges] = {
        "drop_frames": Range(0.0, 1.0, "1", "a share"),
        "added_latency": Range(0.0, 0.5, "s", "beside a camera's own"),
    }

    def __post_init__(self) -> None:
        """Refuse shares that are none and latency beyond the memory."""
        check_settings(self)


@dataclass(frozen=True, slots=True)
class RoomObject:
    """Something that stands in the room.

    Attributes:
        kind: "red box", "blue box" or "white figure".
        x: Where it stands, in [m]; -20 to 20.
        y: Likewise; -20 to 20.
    """

    kind: str
    x: float
    y: float

    ranges: ClassVar[Ranges] = {
        "x": Range(-20.0, 20.0, "m", "outside of any room"),
        "y": Range(-20.0, 20.0, "m", "outside of any room"),
    }

    def __post_init__(self) -> None:
        """Refuse unknown things and places outside of any room."""
        if self.kind not in KINDS:
            raise ConfigurationError(
                f"a thing must be one of {', '.join(KINDS)}, got {self.kind!r}"
            )
        check_settings(self, prefix=f"{self.kind} ")


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """What stands around the robots.

    Attributes:
        walls: Distance of the walls that cameras see from the middle, in [m];
            where a player begins beyond, or less than 1 m inside, they stand
            3.5 m beyond that player; 0 for none; 2 to 20 or 0.
        things: Boxes and figures that stand about.
        plan: Floor plan of the room that they play in, whatever they see
            with; none by default.
    """

    walls: float = 5.0
    things: list[RoomObject] = field(default_factory=list)
    plan: Room | None = None

    ranges: ClassVar[Ranges] = {
        "walls": Range(
            *(2.0, 20.0, "m"),
            "nearer, nobody gets by; farther, nobody sees them",
            also=(0.0,),
        ),
    }

    def __post_init__(self) -> None:
        """Refuse walls that are too near."""
        check_settings(self)
        check_count(self.things, MOST_THINGS, "things")


# In the way of nobody, but in view of both.
CLUTTER = (
    RoomObject("red box", 3.4, 1.6),
    RoomObject("blue box", -1.6, -2.0),
    RoomObject("white figure", 3.2, -1.8),
)
