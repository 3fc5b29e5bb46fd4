"""Head of a robot: its joints, cameras and sonars."""

import tomllib
from dataclasses import dataclass
from math import radians
from typing import Any

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from ..core.rotations import rotation
from .description import RobotDescription

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


def load_head(description: RobotDescription) -> HeadDescription:
    """Read ``head.toml`` in the folder of a robot description.

    Raises:
        ModelError: If there is none, or an entry is missing or ill-typed.
    """
    path = description.folder / FILE
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        table = entries["coupling"]
        rear = entries.get("rear", [])
        rear = [rear] if isinstance(rear, dict) else rear
        return HeadDescription(
            entries["body"],
            description.torso,
            entries["yaw"],
            entries["pitch"],
            entries.get("camera", "upper_camera"),
            np.radians([table[k] for k in ("yaw", "pitch_min", "pitch_max")]),
            _camera(entries["top"]),
            (
                _camera(entries["depth"]),
                *(_camera(each, on_torso=True) for each in rear),
            ),
            tuple(map(_housing, (entries["depth"], *rear))),
            {
                name: Mount(_vector(s["place"]), rotation(*s["turn"]), True)
                for name, s in entries.get("sonar", {}).items()
            },
        )
    except OSError as error:
        raise ModelError(
            f"{description.name} has no cameras: {path} is missing; "
            "without it sensing must be ideal"
        ) from error
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{path}: {error!r}") from error


def _camera(entries: dict[str, Any], *, on_torso: bool = False) -> Mount:
    pitch = radians(entries["pitch"])
    yaw = radians(entries["yaw"]) if on_torso else 0.0
    turn = rotation(0.0, pitch, yaw)
    return Mount(_vector(entries["place"]), turn, on_torso)


def _housing(entries: dict[str, Any]) -> tuple[float, float, float]:
    depth, width, height = _vector(entries["housing"]).tolist()
    return depth, width, height


def _vector(entry: Any) -> Array:
    """Return three numbers. Shape (3,)."""
    vector = np.array(entry, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ValueError(f"needs three numbers [m], got {entry}")
    return vector
