"""Head of a robot: its joints, cameras and sonars."""

import tomllib
from dataclasses import dataclass
from math import radians
from typing import Any

import numpy as np

from ..core.errors import ModelError
from ..core.poses import Array
from .description import RobotDescription

FILE = "head.toml"


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """Return Rz(yaw) Ry(pitch) Rx(roll), angles in [rad]. Shape (3, 3)."""
    cr, sr = np.cos(roll), np.sin(roll)
    cp, sp = np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


@dataclass(frozen=True, slots=True, eq=False)
class Mount:
    """Pose of a sensor on a body.

    Attributes:
        position_in_body: Position in the frame of the body, in [m]. Shape
            (3,).
        axes_in_body: Axes (forward, left, up) of the sensor in the frame of
            the body, as columns. Shape (3, 3).
    """

    position_in_body: Array
    axes_in_body: Array


@dataclass(frozen=True, slots=True, eq=False)
class HeadDescription:
    """Description of an actuated head with its sensors.

    Attributes:
        body: Body that carries the cameras.
        yaw: Yaw joint.
        pitch: Pitch joint.
        camera: Name of the colour camera in the model; one that the model
            lacks is added with camera sensing.
        coupling: Pitch limits by yaw: rows yaw, least pitch, greatest
            pitch, in [rad]. Shape (3, n).
        top: Mount of the colour camera on the body.
        depth: Mount of the depth camera on the body.
        housing: Depth, width and height of the depth camera, in [m].
        sonars: Mounts of the sonars on the torso, by name.
        bottom: Mount of a second colour camera, which looks down; None if
            there is none.
    """

    body: str
    yaw: str
    pitch: str
    camera: str
    coupling: Array
    top: Mount
    depth: Mount
    housing: tuple[float, float, float]
    sonars: dict[str, Mount]
    bottom: Mount | None = None


def load_head(description: RobotDescription) -> HeadDescription:
    """Read ``head.toml`` in the folder of a robot description.

    Raises:
        ModelError: If there is none, or an entry is missing or ill-typed.
    """
    path = description.folder / FILE
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8"))
        table = entries["coupling"]
        return HeadDescription(
            entries["body"],
            entries["yaw"],
            entries["pitch"],
            entries.get("camera", "upper_camera"),
            np.radians([table[k] for k in ("yaw", "pitch_min", "pitch_max")]),
            _camera(entries["top"]),
            _camera(entries["depth"]),
            tuple(entries["depth"]["housing"]),
            {
                name: Mount(np.array(s["place"]), rotation(*s["turn"]))
                for name, s in entries.get("sonar", {}).items()
            },
            _camera(entries["bottom"]) if "bottom" in entries else None,
        )
    except OSError as error:
        raise ModelError(
            f"{description.name} has no cameras: {path} is missing; "
            "without it sensing must be ideal"
        ) from error
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{path}: {error!r}") from error


def _camera(entries: dict[str, Any]) -> Mount:
    pitch = radians(entries["pitch"])
    return Mount(np.array(entries["place"]), rotation(0.0, pitch, 0.0))
