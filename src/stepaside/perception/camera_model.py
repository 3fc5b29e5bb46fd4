"""Pinhole camera model, and the pose of a camera in odometry."""

from dataclasses import dataclass
from functools import lru_cache
from math import atan2, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import ConfigurationError, check_within
from ..core.poses import Array


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Pinhole camera whose frame has x forward, y left and z up."""

    width: int  # [pixels]
    height: int  # [pixels]
    focal_x: float  # horizontal focal length [pixels]
    focal_y: float  # vertical focal length [pixels]

    @classmethod
    def of_field_of_view(
        cls, width: int, height: int, horizontal: float, vertical: float
    ) -> "CameraModel":
        """Return the camera with a size [pixels] and fields of view [rad]."""
        error = ConfigurationError
        for name, size in (("width", width), ("height", height)):
            check_within(size, 8, 4096, name, "pixels", error)
        for name, angle in (
            ("horizontal field of view", horizontal),
            ("vertical field of view", vertical),
        ):
            check_within(angle, 0.05, 2.8, name, "rad", error)
        return cls(
            width,
            height,
            0.5 * width / tan(0.5 * horizontal),
            0.5 * height / tan(0.5 * vertical),
        )

    @property
    def calibration_matrix(self) -> Array:
        """Matrix from camera axes to pixels, as ROS and OpenCV have it.

        Axes are right, down and ahead; pixel centres are at whole numbers,
        while those of this class are at halves.
        """
        return np.array(
            [
                [self.focal_x, 0.0, 0.5 * self.width - 0.5],
                [0.0, self.focal_y, 0.5 * self.height - 0.5],
                [0.0, 0.0, 1.0],
            ]
        )

    def ray(self, u: float, v: float) -> Array:
        """Return the ray of a column and a row in the camera frame, x = 1."""
        return np.array(
            [
                1.0,
                (0.5 * self.width - u) / self.focal_x,
                (0.5 * self.height - v) / self.focal_y,
            ]
        )

    def rays(self) -> Array:
        """Return the rays of all pixel centres. Shape (height, width, 3)."""
        return _rays(self)

    def project(self, points: ArrayLike) -> Array:
        """Return columns and rows of points; NaN for points behind it."""
        x, y, z = np.atleast_2d(np.asarray(points, dtype=float)).T
        x = np.where(x > 1e-9, x, np.nan)
        return np.column_stack(
            [
                0.5 * self.width - self.focal_x * y / x,
                0.5 * self.height - self.focal_y * z / x,
            ]
        )

    def sees(self, point: ArrayLike) -> bool:
        """Return whether a point in the camera frame is in the image."""
        u, v = self.project(point)[0].tolist()
        return bool(0.0 <= u <= self.width and 0.0 <= v <= self.height)


@lru_cache(maxsize=16)
def _rays(model: CameraModel) -> Array:
    u = np.arange(model.width) + 0.5
    v = np.arange(model.height)[:, None] + 0.5
    rays = np.ones((model.height, model.width, 3))
    rays[..., 1] = (0.5 * model.width - u) / model.focal_x
    rays[..., 2] = (0.5 * model.height - v) / model.focal_y
    rays.flags.writeable = False
    return rays


class CameraPose(NamedTuple):
    """Pose of a camera, and position of the robot that carries it."""

    position_in_odometry: Array  # position of the camera [m], (3,)
    axes_in_odometry: Array  # its axes (forward, left, up) as columns, (3, 3)
    # position (x, y) of the torso [m]
    position_torso_in_odometry: tuple[float, float]

    @property
    def heading_in_odometry(self) -> float:
        """Horizontal direction of the camera axis, in [rad]."""
        return atan2(self.axes_in_odometry[1, 0], self.axes_in_odometry[0, 0])

    def ray(self, camera: CameraModel, u: float, v: float) -> Array:
        """Return the ray of a pixel in odometry. Shape (3,)."""
        found: Array = self.axes_in_odometry @ camera.ray(u, v)
        return found

    def rays(self, camera: CameraModel) -> Array:
        """Return rays of unit depth of all pixels, (height, width, 3)."""
        found: Array = camera.rays() @ self.axes_in_odometry.T
        return found

    def distances(self, points_in_odometry: Array) -> Array:
        """Return the horizontal distances [m] of points (..., 2 or 3)."""
        x, y = self.position_torso_in_odometry
        found: Array = np.hypot(
            points_in_odometry[..., 0] - x, points_in_odometry[..., 1] - y
        )
        return found
