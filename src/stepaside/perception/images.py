"""Images and lidar scans with their times."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.poses import Array

if TYPE_CHECKING:
    from .camera_model import CameraModel

Pixels = NDArray[np.uint8]
Depths = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class ColourImage:
    """Colour image."""

    time: float  # middle of its exposure [s]
    camera: "CameraModel"  # camera that took it
    pixels: Pixels  # red, green and blue, (height, width, 3)


@dataclass(frozen=True, slots=True, eq=False)
class DepthImage:
    """Depth image."""

    time: float  # middle of its exposure [s]
    camera: "CameraModel"  # camera that took it
    # depth along the camera axis [m]; 0 without return, (height, width)
    depths: Depths
    near: float  # lower limit of the range [m]
    far: float  # upper limit of the range [m]
    # number of the camera among the depth cameras of the robot
    number: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class LidarScan:
    """Returns of one turn of a lidar."""

    time: float  # middle of the turn [s]
    # positions of the returns in the frame of the torso [m], (n, 3)
    points_in_torso: Array


Percept = ColourImage | DepthImage
AnyPercept = Percept | LidarScan
