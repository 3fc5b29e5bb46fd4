"""Images and sonar echoes with their times."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array
from .camera_model import CameraModel

Pixels = NDArray[np.uint8]
Depths = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class ColourImage:
    """Colour image.

    Attributes:
        time: Middle of its exposure, in [s].
        camera: Camera that took it.
        pixels: Red, green and blue. Shape (height, width, 3).
    """

    time: float
    camera: CameraModel
    pixels: Pixels


@dataclass(frozen=True, slots=True, eq=False)
class DepthImage:
    """Depth image.

    Attributes:
        time: Middle of its exposure, in [s].
        camera: Camera that took it.
        depths: Depth along the camera axis, in [m]; 0 without return. Shape
            (height, width).
        near: Lower limit of the range, in [m].
        far: Upper limit of the range, in [m].
        number: Number of the camera among the depth cameras of the robot.
    """

    time: float
    camera: CameraModel
    depths: Depths
    near: float
    far: float
    number: int = 0


@dataclass(frozen=True, slots=True)
class SonarEcho:
    """Sonar echo, or the absence of one.

    Attributes:
        time: Time of the echo, in [s].
        sonar: Name of the sonar.
        distance: Distance of the nearest object in its cone, in [m]; None
            without echo.
    """

    time: float
    sonar: str
    distance: float | None


@dataclass(frozen=True, slots=True, eq=False)
class LidarScan:
    """Returns of one turn of a lidar.

    Attributes:
        time: Middle of the turn, in [s].
        points_in_torso: Positions of the returns in the frame of the torso,
            in [m]. Shape (n, 3).
    """

    time: float
    points_in_torso: Array


Percept = ColourImage | DepthImage | SonarEcho
AnyPercept = Percept | LidarScan
