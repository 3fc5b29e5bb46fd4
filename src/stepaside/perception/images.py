"""What cameras and sonars hand over, each with the time it was taken."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .camera_model import CameraModel

Pixels = NDArray[np.uint8]
Depths = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class ColourImage:
    """A colour image.

    Attributes:
        time: Middle of its exposure, in [s].
        camera: Camera that took it.
        pixels: Red, green and blue. Shape (height, width, 3).
        low: Whether it is of the lower camera of a head that has two.
    """

    time: float
    camera: CameraModel
    pixels: Pixels
    low: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class DepthImage:
    """A depth image.

    Attributes:
        time: Middle of its exposure, in [s].
        camera: Camera that took it.
        depths: Depth along the camera's axis, in [m]; 0 where nothing came
            back. Shape (height, width).
        near: Nothing nearer comes back, in [m].
        far: Nothing farther comes back, in [m].
    """

    time: float
    camera: CameraModel
    depths: Depths
    near: float
    far: float


@dataclass(frozen=True, slots=True)
class SonarEcho:
    """An echo, or silence.

    Attributes:
        time: When it was heard, in [s].
        sonar: Name of the sonar.
        distance: Distance of the nearest thing in its cone, in [m]; None
            if all was silent.
    """

    time: float
    sonar: str
    distance: float | None


Percept = ColourImage | DepthImage | SonarEcho
