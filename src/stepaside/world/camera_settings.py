"""Settings of what the robots see with, and of the room around them."""

from dataclasses import dataclass, field
from math import radians

from ..errors import (
    ConfigurationError,
    check_not_negative,
    check_positive,
    check_within,
)
from ..sensing.camera_model import CameraModel

ERROR = ConfigurationError
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
        width: Columns; the V6 offers 320 and more, both offer 160.
        height: Rows.
        rate: Images per second, in [1/s]; the sensor gives up to 30.
        latency: From exposure to the image in hand, in [s].
        noise: Standard deviation of a pixel, of 255.
        renderer: One of ``RENDERERS``.
    """

    optics: str = "v5"
    width: int = 320
    height: int = 240
    rate: float = 15.0
    latency: float = 0.05
    noise: float = 4.0
    renderer: str = "auto"

    def __post_init__(self) -> None:
        """Refuse what no such camera is."""
        if self.optics not in OPTICS:
            raise ConfigurationError(
                f"optics must be one of {', '.join(OPTICS)}, "
                f"got {self.optics!r}"
            )
        check_within(self.rate, 1.0, 60.0, "rate", "1/s", ERROR)
        check_within(self.latency, 0.0, 1.0, "latency", "s", ERROR)
        check_within(self.noise, 0.0, 64.0, "noise", "1", ERROR)
        self.model()

    def model(self) -> CameraModel:
        """Pinhole camera with these optics."""
        across, down = (radians(a) for a in OPTICS[self.optics])
        size = self.width, self.height
        return CameraModel.of_field_of_view(*size, across, down)


@dataclass(frozen=True, slots=True)
class DepthSettings:
    """The ASUS Xtion on the evader's head.

    Attributes:
        width: Columns that are used, of 640.
        height: Rows that are used, of 480.
        rate: Images per second, in [1/s]; the sensor gives 30.
        latency: From exposure to the image in hand, in [s].
        near: Nothing nearer comes back, in [m].
        far: Nothing farther comes back, in [m].
        noise: Standard deviation at 1 m, in [m]; it grows with the square.
        step: Quantum at 1 m, in [m]; it grows with the square.
        missing: Share of the pixels that nothing comes back to.
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

    def __post_init__(self) -> None:
        """Refuse what no such camera is."""
        check_within(self.rate, 1.0, 60.0, "rate", "1/s", ERROR)
        check_within(self.latency, 0.0, 1.0, "latency", "s", ERROR)
        check_positive(self.near, "near", "m", ERROR)
        check_within(self.far, self.near, 20.0, "far", "m", ERROR)
        check_not_negative(self.noise, "noise", "m", ERROR)
        check_positive(self.step, "step", "m", ERROR)
        check_within(self.missing, 0.0, 1.0, "missing", "1", ERROR)
        self.model()

    def model(self) -> CameraModel:
        """Pinhole camera with the optics of the Xtion."""
        return CameraModel.of_field_of_view(
            self.width, self.height, radians(58.0), radians(45.0)
        )


@dataclass(frozen=True, slots=True)
class SonarSettings:
    """NAO's sonars, V5 and V6.

    Attributes:
        rate: Echoes per second of each, in [1/s]; assumed.
        near: Nearer things sound as near as this, in [m].
        far: Farther things are not heard, in [m].
        cone: Opening angle, in [rad].
        noise: Standard deviation, in [m].
        step: Quantum, in [m].
    """

    rate: float = 10.0
    near: float = 0.2
    far: float = 0.8
    cone: float = radians(60.0)
    noise: float = 0.01
    step: float = 0.01

    def __post_init__(self) -> None:
        """Refuse what no sonar is."""
        check_within(self.rate, 1.0, 40.0, "rate", "1/s", ERROR)
        check_positive(self.near, "near", "m", ERROR)
        check_within(self.far, self.near, 10.0, "far", "m", ERROR)
        check_within(self.cone, 0.05, 2.5, "cone", "rad", ERROR)
        check_not_negative(self.noise, "noise", "m", ERROR)
        check_positive(self.step, "step", "m", ERROR)


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """Everything that a robot perceives the other with.

    Attributes:
        colour: The camera in the head of either robot.
        depth: The depth camera on the evader's head.
        sonar: The sonars in the evader's chest.
        drop_frames: Share of the images that never arrive.
        added_latency: Latency on top of each camera's own, in [s].
    """

    colour: ColourSettings = field(default_factory=ColourSettings)
    depth: DepthSettings = field(default_factory=DepthSettings)
    sonar: SonarSettings = field(default_factory=SonarSettings)
    drop_frames: float = 0.0
    added_latency: float = 0.0

    def __post_init__(self) -> None:
        """Refuse shares that are none and latency beyond the memory."""
        check_within(self.drop_frames, 0.0, 1.0, "drop_frames", "1", ERROR)
        check_within(self.added_latency, 0.0, 0.5, "added_latency", "s", ERROR)


@dataclass(frozen=True, slots=True)
class Thing:
    """Something that stands in the room.

    Attributes:
        kind: "red box", "blue box" or "white figure".
        x: Where it stands, in [m].
        y: Likewise.
    """

    kind: str
    x: float
    y: float

    def __post_init__(self) -> None:
        """Refuse unknown things and places outside of any room."""
        if self.kind not in KINDS:
            raise ConfigurationError(
                f"a thing must be one of {', '.join(KINDS)}, got {self.kind!r}"
            )
        for name in ("x", "y"):
            value = getattr(self, name)
            where = f"{name} of the {self.kind}"
            check_within(value, -20.0, 20.0, where, "m", ERROR)


@dataclass(frozen=True, slots=True)
class RoomSettings:
    """What stands around the robots.

    Attributes:
        walls: Distance of the walls from the middle, in [m]; 0 for none.
        things: Boxes and figures that stand about.
    """

    walls: float = 5.0
    things: list[Thing] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Refuse walls that are too near."""
        if self.walls:
            check_within(self.walls, 2.0, 20.0, "walls", "m", ERROR)


# In the way of nobody, but in view of both.
CLUTTER = (
    Thing("red box", 3.4, 1.6),
    Thing("blue box", -1.6, -2.0),
    Thing("white figure", 3.2, -1.8),
)
