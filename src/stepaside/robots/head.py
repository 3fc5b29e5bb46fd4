"""Head of a robot: its joints, cameras and sonars."""

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
    """Pose of a sensor on a body: the head, or the torso.

    Attributes:
        position_in_body: Position in the frame of the body, in [m]. Shape
            (3,).
        axes_in_body: Axes (forward, left, up) of the sensor in the frame of
            the body, as columns. Shape (3, 3).
        on_torso: Whether the body is the torso, which the head joints do not
            turn.
    """

    position_in_body: Array
    axes_in_body: Array
    on_torso: bool = False


def depth_camera_name(number: int) -> str:
    """Return the name of a depth camera in exports, by its number."""
    return f"depth_camera_{number}" if number else "depth_camera"


@dataclass(frozen=True, slots=True, eq=False)
class HeadDescription:
    """Description of an actuated head with its sensors.

    Attributes:
        body: Body that carries the cameras of the head.
        torso: Body that carries all other sensors.
        yaw: Yaw joint.
        pitch: Pitch joint.
        camera: Name of the colour camera in the model; one that the model
            lacks is added with camera sensing.
        coupling: Pitch limits by yaw: rows yaw, least pitch, greatest
            pitch, in [rad]. Shape (3, n).
        top: Mount of the colour camera on the body.
        depth: Mounts of the depth cameras: the first on the head, any others
            on the torso.
        housings: Depth, width and height of each depth camera, in [m].
        sonars: Mounts of the sonars on the torso, by name.
    """

    body: str
    torso: str
    yaw: str
    pitch: str
    camera: str
    coupling: Array
    top: Mount
    depth: tuple[Mount, ...]
    housings: tuple[tuple[float, float, float], ...]
    sonars: dict[str, Mount]

    def body_of(self, mount: Mount) -> str:
        """Return the name of the body of a mount."""
        return self.torso if mount.on_torso else self.body

    def depth_mounts(self, *, rear: bool) -> tuple[Mount, ...]:
        """Return the mounts of the depth cameras that are used.

        Args:
            rear: Whether those on the torso are.

        Raises:
            ModelError: If they are, and there is none.
        """
        if not rear:
            return self.depth[:1]
        if len(self.depth) == 1:
            raise ModelError(
                f"the robot has no rear camera: {FILE} needs [rear] with "
                "place, pitch, yaw and housing"
            )
        return self.depth


ANGLE = Range(-180.0, 180.0, "deg", "half a turn")


@dataclass(frozen=True)
class _CameraEntries:
    """Camera on the head in ``head.toml``."""

    place: Place = setting(REQUIRED, "Place in the frame of the body [m]")
    pitch: float = setting(REQUIRED, "Pitch, positive downward", ANGLE)

    def mount(self, yaw: float | None = None) -> Mount:
        """Return the mount; a yaw, in [deg], is of one on the torso."""
        turn = rotation(0.0, radians(self.pitch), radians(yaw or 0.0))
        return Mount(np.array(self.place), turn, yaw is not None)


@dataclass(frozen=True)
class _DepthEntries(_CameraEntries):
    """Depth camera on the head."""

    housing: Place = setting(REQUIRED, "Depth, width and height [m]")


@dataclass(frozen=True)
class _RearEntries(_DepthEntries):
    """Depth camera on the torso."""

    yaw: float = setting(REQUIRED, "Yaw, positive leftward", ANGLE)


@dataclass(frozen=True)
class _SonarEntries:
    """Sonar in ``head.toml``, on the torso."""

    place: Place = setting(REQUIRED, "Place in the frame of the torso [m]")
    turn: Place = setting(REQUIRED, "Roll, pitch and yaw [rad]")


@dataclass(frozen=True)
class _CouplingEntries:
    """Pitch limits by yaw in ``head.toml``."""

    yaw: tuple[float, ...] = setting(REQUIRED, "Yaw, ascending", ANGLE)
    pitch_min: tuple[float, ...] = setting(REQUIRED, "Least pitch", ANGLE)
    pitch_max: tuple[float, ...] = setting(REQUIRED, "Greatest pitch", ANGLE)

    def __post_init__(self) -> None:
        """Check that there are as many limits as yaws."""
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
    top: _CameraEntries = setting(REQUIRED, "Colour camera")
    depth: _DepthEntries = setting(REQUIRED, "Depth camera")
    camera: str = setting("upper_camera", "Colour camera in the model")
    rear: _RearEntries | tuple[_RearEntries, ...] = setting(
        (), "Depth cameras on the torso"
    )
    sonar: dict[str, _SonarEntries] = setting(
        dict[str, _SonarEntries](), "Sonars by name"
    )


def load_head(description: RobotDescription) -> HeadDescription:
    """Read ``head.toml`` in the folder of a robot description.

    Raises:
        ModelError: If there is none, or entries do not fit.
    """
    path = description.folder / FILE
    if not path.is_file():
        raise ModelError(
            f"{description.name} has no cameras: {path} is missing; "
            "without it sensing must be ideal"
        )
    own = read_entries(
        _HeadEntries,
        load_entries(path, ModelError),
        str(path),
        error=ModelError,
    )
    rear = own.rear if isinstance(own.rear, tuple) else (own.rear,)
    return HeadDescription(
        own.body,
        description.torso,
        own.yaw,
        own.pitch,
        own.camera,
        np.radians([*vars(own.coupling).values()]),
        own.top.mount(),
        (own.depth.mount(), *(each.mount(each.yaw) for each in rear)),
        (own.depth.housing, *(each.housing for each in rear)),
        {
            name: Mount(np.array(each.place), rotation(*each.turn), True)
            for name, each in own.sonar.items()
        },
    )
