"""What turns a robot's head and where its eyes and ears are."""

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
    """Matrix Rz(yaw) Ry(pitch) Rx(roll), angles in [rad]. Shape (3, 3)."""
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
    """Where a sensor sits on a body.

    Attributes:
        place: Its place in the body's frame, in [m]. Shape (3,).
        axes: Its axes (forward, left, up) as columns. Shape (3, 3).
    """

    place: Array
    axes: Array


@dataclass(frozen=True, slots=True, eq=False)
class HeadDescription:
    """A head that turns, as the folder of its robot describes it.

    Attributes:
        body: Body that carries the cameras.
        yaw: Joint that turns it aside.
        pitch: Joint that nods it.
        camera: The colour camera, as the model calls it.
        coupling: Yaw, least pitch and greatest pitch, in [rad].
            Shape (3, n).
        top: Mount of the colour camera on the body.
        depth: Mount of the depth camera on the body.
        housing: Size of the depth camera, in [m]: depth, width, height.
        sonars: Mounts of the sonars on the torso, by name.
        bottom: Mount of a second colour camera, which looks down, if there
            is one.
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
    """Read the head of a robot from the folder of its description.

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
            entries["camera"],
            np.radians([table[k] for k in ("yaw", "pitch_min", "pitch_max")]),
            _camera(entries["top"]),
            _camera(entries["depth"]),
            tuple(entries["depth"]["housing"]),
            {
                name: Mount(np.array(s["place"]), rotation(*s["turn"]))
                for name, s in entries["sonar"].items()
            },
            _camera(entries["bottom"]) if "bottom" in entries else None,
        )
    except OSError as error:
        raise ModelError(
            f"{description.name} cannot look about: {path} is missing; "
            "without it sensing must be ideal"
        ) from error
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{path}: {error!r}") from error


def _camera(entries: dict[str, Any]) -> Mount:
    pitch = radians(entries["pitch"])
    return Mount(np.array(entries["place"]), rotation(0.0, pitch, 0.0))
