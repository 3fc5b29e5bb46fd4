"""Poses of cameras in odometry."""

from math import atan2
from typing import NamedTuple

import numpy as np

from ..core.poses import Array
from ..robots.body_pose import BodyPose
from ..robots.head import Mount
from .camera_model import CameraModel


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


def camera_pose(body: BodyPose, mount: Mount) -> CameraPose:
    """Return the pose of a camera in odometry."""
    position, axes = body.position_head_in_odometry, body.axes_head_in_odometry
    if mount.on_torso:
        position = body.position_torso_in_odometry
        axes = body.axes_torso_in_odometry
    return CameraPose(
        position + axes @ mount.position_in_body,
        axes @ mount.axes_in_body,
        body.pose_torso_in_odometry[:2],
    )
