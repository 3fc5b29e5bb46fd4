"""Settings of cameras and lidar, and of the scene around the robots."""

from dataclasses import dataclass
from math import radians

from ..core.errors import ConfigurationError, check_within
from ..core.ranges import Range
from ..core.setting import REQUIRED, CheckedSettings, check_settings, setting

PIXELS = Range(
    8,
    4096,
    "pixels",
    "too few to detect anything; more do not fit in memory",
    whole=True,
)
RATE = Range(1.0, 60.0, "1/s", "typical of such sensors")
LATENCY = Range(0.0, 1.0, "s", "how long a robot stores its poses")
VIEW = Range(0.1, 2.6, "rad", "a narrow lens; beyond, no flat image")
QUANTUM = Range(1e-6, 1.0, "m", "from below the noise to useless")
MAX_OBJECTS = 100  # in a room
KINDS = ("red box", "blue box", "white figure")
# Horizontal and vertical field of view of NAO's top camera, in [deg].
OPTICS = {"v5": (60.9, 47.6), "v6": (54.7, 42.5)}
BACKENDS = ("egl", "osmesa")  # off-screen graphics
RAYCAST = "raycast"  # without graphics
RENDERERS = ("auto", *BACKENDS, RAYCAST)


@dataclass(frozen=True, slots=True)
class ColourSettings(CheckedSettings):
    """Settings of NAO's top camera."""

    optics: str = setting(
        "v5",
        "NAO version whose top camera is simulated",
        names=OPTICS,
    )
    width: int = setting(
        320,
        "Image width {unit}; the V6 offers 320 and more, both offer 160",
        PIXELS,
    )
    height: int = setting(240, "Image height", PIXELS)
    rate: float = setting(
        15.0, "Frame rate {unit}; the sensor gives up to 30", RATE
    )
    latency: float = setting(
        0.05, "Latency, from exposure to arrival", LATENCY
    )
    noise: float = setting(
        4.0,
        "Standard deviation of a pixel value, of 255",
        Range(0.0, 64.0, "1", "a quarter of all levels"),
    )
    renderer: str = setting(
        "auto",
        "Renderer of the camera images",
        names=RENDERERS,
    )

    @property
    def view(self) -> tuple[float, float]:
        """Horizontal and vertical field of view, in [rad]."""
        across, down = OPTICS[self.optics]
        return radians(across), radians(down)


@dataclass(frozen=True, slots=True)
class DepthSettings:
    """Settings of a depth camera; by default the ASUS Xtion."""

    width: int = setting(80, "Image columns that are used", PIXELS)
    height: int = setting(60, "Image rows that are used", PIXELS)
    across: float = setting(radians(58.0), "Horizontal field of view", VIEW)
    down: float = setting(radians(45.0), "Vertical field of view", VIEW)
    rate: float = setting(15.0, "Frame rate {unit}; the sensor gives 30", RATE)
    latency: float = setting(
        0.05, "Latency, from exposure to arrival", LATENCY
    )
    near: float = setting(
        0.8,
        "Shortest distance that is measured",
        Range(0.01, 20.0, "m", "the size of a lens"),
    )
    far: float = setting(
        3.5,
        "Longest distance that is measured",
        Range(0.01, 20.0, "m", "from near to the size of a room"),
    )
    noise: float = setting(
        0.0019,
        "Standard deviation at a distance of 1 m {unit}; proportional to the "
        "squared distance",
        Range(0.0, 1.0, "m", "more is no measurement"),
    )
    step: float = setting(
        0.00285,
        "Resolution at a distance of 1 m {unit}; proportional to the squared "
        "distance",
        QUANTUM,
    )
    missing: float = setting(
        0.02,
        "Fraction of pixels without return",
        Range(0.0, 1.0, "1", "a fraction"),
    )

    def __post_init__(self) -> None:
        check_settings(self)
        check_within(self.far, self.near, 20.0, "far", "m", ConfigurationError)

    @property
    def view(self) -> tuple[float, float]:
        """Horizontal and vertical field of view, in [rad]."""
        return self.across, self.down


# Depth cameras, by name. Rate, latency and noise of the second are as of the
# first: the noise that the vendor's formula gives for it is the same, too.
DEPTH_CAMERAS = {
    "xtion": DepthSettings(),
    "d455": DepthSettings(
        width=106, across=radians(87.0), down=radians(58.0), near=0.6, far=6.0
    ),
}


@dataclass(frozen=True, slots=True)
class LidarSettings(CheckedSettings):
    """Lidar above the head; rate, noise and near limit of Livox's Mid-360."""

    rays: int = setting(
        360,
        "Rays of each of four elevations",
        Range(36, 4096, "1", "a ray per 10 deg; more take long", whole=True),
    )
    rate: float = setting(10.0, "Turns per second", RATE)
    latency: float = setting(0.05, "Latency, from a turn to arrival", LATENCY)
    near: float = setting(
        0.1,
        "Shortest distance that is measured",
        Range(0.01, 20.0, "m", "the size of a lens"),
    )
    far: float = setting(
        10.0,
        "Longest distance that is measured",
        Range(0.01, 100.0, "m", "from near to the end of a hall"),
    )
    noise: float = setting(
        0.02,
        "Standard deviation of a distance",
        Range(0.0, 1.0, "m", "more is no measurement"),
    )
    missing: float = setting(
        0.02,
        "Fraction of rays without return",
        Range(0.0, 1.0, "1", "a fraction"),
    )


@dataclass(frozen=True, slots=True)
class CameraSettings(CheckedSettings):
    """Settings of all exteroceptive sensors of the robots."""

    colour: ColourSettings = setting(
        ColourSettings(), "Top camera in the head of each robot"
    )
    depth: DepthSettings = setting(
        DepthSettings(),
        "Depth camera on the evader's head",
        presets=DEPTH_CAMERAS,
    )
    rear_camera: bool = setting(
        False,
        "Whether the evader uses the depth cameras on its torso",
    )
    rear: DepthSettings = setting(
        DEPTH_CAMERAS["d455"],
        "Depth cameras on the evader's torso",
        presets=DEPTH_CAMERAS,
        needs=("cameras.rear_camera", ""),
    )
    drop_frames: float = setting(
        0.0,
        "Fraction of images that are lost",
        Range(0.0, 1.0, "1", "a fraction"),
    )
    added_latency: float = setting(
        0.0,
        "Latency in addition to that of the camera",
        Range(0.0, 0.5, "s", "in addition to a camera's latency"),
    )


@dataclass(frozen=True, slots=True)
class RoomObject(CheckedSettings, prefix="room object "):
    """Object in the room."""

    kind: str = setting(REQUIRED, "Kind of object", names=KINDS)
    x: float = setting(
        REQUIRED,
        "Position along x of the world",
        Range(-20.0, 20.0, "m", "beyond, outside any room"),
    )
    y: float = setting(
        REQUIRED,
        "Position along y of the world",
        Range(-20.0, 20.0, "m", "beyond, outside any room"),
    )


# Outside the path of a duel, but in view of both robots.
CLUTTER = (
    RoomObject("red box", 3.4, 1.6),
    RoomObject("blue box", -1.6, -2.0),
    RoomObject("white figure", 3.2, -1.8),
)


@dataclass(frozen=True, slots=True)
class SceneSettings(CheckedSettings):
    """Walls and objects around the robots, as cameras see them."""

    walls: float = setting(
        5.0,
        "Distance of the visible walls from the origin {unit}; 0 for none; a "
        "player who begins beyond, or less than 1 m inside, moves them to "
        "3.5 m beyond",
        Range(
            2.0,
            20.0,
            "m",
            "nearer, no way past them; farther, out of sight",
            also=(0.0,),
        ),
    )
    things: list[RoomObject] = setting(
        [],
        "Objects in view of the cameras",
        presets={"clutter": list(CLUTTER), "none": []},
        count=(0, MAX_OBJECTS),
    )
