"""Head of a robot: its joints and cameras."""

from dataclasses import dataclass
from math import radians

import numpy as np

from ..core.entries import load_entries, read_entries
from ..core.errors import ModelError
from ..core.poses import Array
from ..core.ranges import Range
from ..core.rotations import rotation
from ..core.setting import REQUIRED, setting
from .description import RobotDescription
from .description_types import Place

FILE = "head.toml"


@dataclass(frozen=True, slots=True, eq=False)
class Mount:
    """Pose of a sensor on a body: the head, or the torso."""

    position_in_body: Array  # position in the frame of the body [m], (3,)
    # axes (forward, left, up) of the sensor, as columns, (3, 3)
    axes_in_body: Array
    # whether the body is the torso, which the head joints do not turn
    on_torso: bool = False


def depth_camera_name(number: int) -> str:
    """Return the name of a depth camera in exports, by its number."""
    return f"depth_camera_{number}" if number else "depth_camera"


@dataclass(frozen=True, slots=True, eq=False)
class HeadDescription:
    """Description of an actuated head with its sensors."""

    body: str  # body that carries the cameras of the head
    torso: str  # body that carries all other sensors
    yaw: str
    pitch: str
    # name of the colour camera in the model; one that the model lacks is added
    # with camera sensing
    camera: str
    # pitch limits by yaw: rows yaw, least pitch, greatest pitch [rad], (3, n)
    coupling: Array
    top: Mount  # mount of the colour camera on the body
    # mounts of the depth cameras: the first on the head, any others on the
    # torso
    depth: tuple[Mount, ...]

    def body_of(self, mount: Mount) -> str:
        """Return the name of the body of a mount."""
        return self.torso if mount.on_torso else self.body

    def depth_mounts(self, *, rear: bool) -> tuple[Mount, ...]:
        """Return the mounts of the depth cameras, the rear ones if wanted."""
        if not rear:
            return self.depth[:1]
        if len(self.depth) == 1:
            raise ModelError(
                f"the robot has no rear camera: {FILE} needs [rear] with "
                "place, pitch and yaw"
            )
        return self.depth


ANGLE = Range(-180.0, 180.0, "deg", "half a turn")


@dataclass(frozen=True)
class _SensorEntries:
    """Camera in ``head.toml``."""

    place: Place = setting(REQUIRED, "Place in the frame of the body [m]")
    roll: float = setting(0.0, "Roll", ANGLE)
    pitch: float = setting(0.0, "Pitch, positive downward", ANGLE)
    yaw: float = setting(0.0, "Yaw, positive leftward", ANGLE)

    def mount(self, *, on_torso: bool = False) -> Mount:
        """Return the mount."""
        turn = radians(self.roll), radians(self.pitch), radians(self.yaw)
        return Mount(np.array(self.place), rotation(*turn), on_torso)


@dataclass(frozen=True)
class _CouplingEntries:
    """Pitch limits by yaw in ``head.toml``."""

    yaw: tuple[float, ...] = setting(REQUIRED, "Yaw, ascending", ANGLE)
    pitch_min: tuple[float, ...] = setting(REQUIRED, "Least pitch", ANGLE)
    pitch_max: tuple[float, ...] = setting(REQUIRED, "Greatest pitch", ANGLE)

    def __post_init__(self) -> None:
        if not len(self.yaw) == len(self.pitch_min) == len(self.pitch_max):
            raise ModelError(
                "coupling: yaw, pitch_min and pitch_max must have as many "
                f"entries, got {len(self.yaw)}, {len(self.pitch_min)} and "
                f"{len(self.pitch_max)}"
            )


@dataclass(frozen=True)
class _HeadEntries:
    """Entries of ``head.toml``."""

    body: str = setting(REQUIRED, "Body that carries the cameras")
    yaw: str = setting(REQUIRED, "Yaw joint")
    pitch: str = setting(REQUIRED, "Pitch joint")
    coupling: _CouplingEntries = setting(REQUIRED, "Pitch limits by yaw")
    top: _SensorEntries = setting(REQUIRED, "Colour camera")
    depth: _SensorEntries = setting(REQUIRED, "Depth camera")
    camera: str = setting("upper_camera", "Colour camera in the model")
    rear: _SensorEntries | tuple[_SensorEntries, ...] = setting(
        (), "Depth cameras on the torso"
    )


def load_head(description: RobotDescription) -> HeadDescription:
    """Read ``head.toml`` in the folder of a robot description."""
    path = description.folder / FILE
    if not path.is_file():
        raise ModelError(
            f"{description.name} has no cameras: {path} is missing; "
            "without it sensing must be ideal"
        )
    entries = load_entries(path, ModelError)
    own = read_entries(_HeadEntries, entries, str(path), error=ModelError)
    rear = own.rear if isinstance(own.rear, tuple) else (own.rear,)
    return HeadDescription(
        own.body,
        description.torso,
        own.yaw,
        own.pitch,
        own.camera,
        np.radians([*vars(own.coupling).values()]),
        own.top.mount(),
        (own.depth.mount(), *(each.mount(on_torso=True) for each in rear)),
    )
