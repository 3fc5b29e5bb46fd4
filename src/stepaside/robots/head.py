"""Head of a robot: its joints and cameras."""

from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import ClassVar

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
ANGLE = Range(-180.0, 180.0, "deg", "half a turn")


@dataclass(frozen=True)
class Mount:
    """Pose of a sensor on the head."""

    on_torso: ClassVar[bool] = False  # where the head joints do not turn it
    place: Place = setting(REQUIRED, "Place in the frame of the body [m]")
    roll: float = setting(0.0, "Roll", ANGLE)
    pitch: float = setting(0.0, "Pitch, positive downward", ANGLE)
    yaw: float = setting(0.0, "Yaw, positive leftward", ANGLE)

    @cached_property
    def position_in_body(self) -> Array:
        """Position in the frame of the body, in [m]. Shape (3,)."""
        return np.array(self.place, dtype=np.float64)

    @cached_property
    def axes_in_body(self) -> Array:
        """Axes forward, left and up, as columns. Shape (3, 3)."""
        return rotation(*map(radians, (self.roll, self.pitch, self.yaw)))


@dataclass(frozen=True)
class TorsoMount(Mount):
    """Pose of a sensor on the torso."""

    on_torso: ClassVar[bool] = True


def depth_camera_name(number: int) -> str:
    """Return the name of a depth camera in exports, by its number."""
    return f"depth_camera_{number}" if number else "depth_camera"


@dataclass(frozen=True)
class YawCoupling:
    """Pitch limits by yaw."""

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
class HeadDescription:
    """Description of an actuated head with its sensors: ``head.toml``."""

    torso: str
    body: str = setting(REQUIRED, "Body that carries the cameras")
    yaw: str = setting(REQUIRED, "Yaw joint")
    pitch: str = setting(REQUIRED, "Pitch joint")
    coupling: YawCoupling = setting(REQUIRED, "Pitch limits by yaw")
    top: Mount = setting(REQUIRED, "Colour camera")
    depth: Mount = setting(REQUIRED, "Depth camera")
    camera: str = setting(
        "upper_camera",
        "Colour camera in the model; one that it lacks is added with camera "
        "sensing",
    )
    rear: TorsoMount | tuple[TorsoMount, ...] = setting(
        (), "Depth cameras on the torso"
    )

    @cached_property
    def pitch_limits(self) -> Array:
        """Rows yaw, least and greatest pitch, in [rad]. Shape (3, n)."""
        return np.radians([*vars(self.coupling).values()])

    @cached_property
    def depth_cameras(self) -> tuple[Mount, ...]:
        """Mounts of all depth cameras; the first is on the head."""
        rear = self.rear if isinstance(self.rear, tuple) else (self.rear,)
        return self.depth, *rear

    def body_of(self, mount: Mount) -> str:
        """Return the name of the body of a mount."""
        return self.torso if mount.on_torso else self.body

    def depth_mounts(self, *, rear: bool) -> tuple[Mount, ...]:
        """Return the mounts of the depth cameras, the rear ones if wanted."""
        if rear and not self.rear:
            raise ModelError(
                f"the robot has no rear camera: {FILE} needs [rear] with "
                "place, pitch and yaw"
            )
        return self.depth_cameras if rear else (self.depth,)


def load_head(description: RobotDescription) -> HeadDescription:
    """Read ``head.toml`` in the folder of a robot description."""
    path = description.folder / FILE
    if not path.is_file():
        raise ModelError(
            f"{description.name} has no cameras: {path} is missing; "
            "without it sensing must be ideal"
        )
    entries = load_entries(path, ModelError) | {"torso": description.torso}
    return read_entries(HeadDescription, entries, str(path), error=ModelError)
