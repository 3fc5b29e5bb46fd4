"""Poses of body and cameras in odometry at the time of an image."""

from bisect import insort
from collections import deque
from collections.abc import Callable
from functools import partial
from math import atan2
from typing import NamedTuple

import numpy as np

from ..core.poses import Array, Pose
from ..robots.body_pose import BodyKinematics, BodyPose
from ..robots.head import Mount
from .camera_model import CameraModel

POSE_MEMORY = 1.0  # how long past poses are stored, in [s]


class CameraPose(NamedTuple):
    """Pose of a camera, and position of the robot that carries it.

    Attributes:
        position_in_odometry: Position of the camera, in [m]. Shape (3,).
        axes_in_odometry: Its axes (forward, left, up) as columns.
            Shape (3, 3).
        position_torso_in_odometry: Position (x, y) of the torso, in [m].
    """

    position_in_odometry: Array
    axes_in_odometry: Array
    position_torso_in_odometry: tuple[float, float]

    @property
    def heading_in_odometry(self) -> float:
        """Horizontal direction of the camera axis, in [rad]."""
        return atan2(self.axes_in_odometry[1, 0], self.axes_in_odometry[0, 0])

    def ray(self, camera: CameraModel, u: float, v: float) -> Array:
        """Return the ray of a pixel in odometry. Shape (3,).

        Args:
            camera: Camera model.
            u: Column from the left edge, in [pixels].
            v: Row from the upper edge, in [pixels].
        """
        found: Array = self.axes_in_odometry @ camera.ray(u, v)
        return found

    def rays(self, camera: CameraModel) -> Array:
        """Return the rays of all pixels in odometry.

        Args:
            camera: Camera model.

        Returns:
            Rays of unit depth. Shape (height, width, 3).
        """
        found: Array = camera.rays() @ self.axes_in_odometry.T
        return found

    def distances(self, points_in_odometry: Array) -> Array:
        """Return the horizontal distances of points from the torso, in [m].

        Args:
            points_in_odometry: Points, in [m]. Shape (..., 2 or 3).
        """
        x, y = self.position_torso_in_odometry
        found: Array = np.hypot(
            points_in_odometry[..., 0] - x, points_in_odometry[..., 1] - y
        )
        return found


def camera_pose(body: BodyPose, mount: Mount) -> CameraPose:
    """Return the pose of a camera in odometry.

    Args:
        body: Pose of the body.
        mount: Mount of the camera.
    """
    position, axes = body.position_head_in_odometry, body.axes_head_in_odometry
    if mount.on_torso:
        position = body.position_torso_in_odometry
        axes = body.axes_torso_in_odometry
    return CameraPose(
        position + axes @ mount.position_in_body,
        axes @ mount.axes_in_body,
        body.pose_torso_in_odometry[:2],
    )


class _DeferredPose:
    """Body pose that is computed when it is first used."""

    __slots__ = ("_compute", "_pose", "time")

    def __init__(self, time: float, compute: Callable[[], BodyPose]) -> None:
        self.time, self._compute = time, compute
        self._pose: BodyPose | None = None

    @property
    def pose(self) -> BodyPose:
        if self._pose is None:
            self._pose = self._compute()
        return self._pose


class PoseHistory:
    """Body poses of the last second.

    Images arrive with latency; each is evaluated with the pose of the body
    at its exposure.
    """

    def __init__(self, tick: float) -> None:
        """Begin empty.

        Args:
            tick: Time between two poses, in [s].
        """
        self._poses: deque[_DeferredPose] = deque(
            maxlen=round(POSE_MEMORY / tick)
        )

    def add_pose(self, pose: BodyPose) -> None:
        """Store a pose; its time may be earlier than the latest."""
        self._insert(pose.time, lambda: pose)

    @property
    def latest(self) -> BodyPose | None:
        """Latest pose; None before the first measurement."""
        return self._poses[-1].pose if self._poses else None

    def at(self, time: float) -> BodyPose:
        """Return the pose at a time, in [s], or else the oldest one."""
        for past in reversed(self._poses):
            if past.time <= time + 1e-9:
                return past.pose
        return self._poses[0].pose

    def _insert(self, time: float, compute: Callable[[], BodyPose]) -> None:
        if len(self._poses) == self._poses.maxlen:
            self._poses.popleft()
        entry = _DeferredPose(time, compute)
        if self._poses and time < self._poses[-1].time:
            insort(self._poses, entry, key=lambda past: past.time)
        else:
            self._poses.append(entry)


class BodyPoseHistory(PoseHistory):
    """Body poses by kinematics, computed only where an image needs one.

    Attributes:
        kinematics: Kinematics of the body.
    """

    def __init__(self, kinematics: BodyKinematics, tick: float) -> None:
        """Begin empty.

        Args:
            kinematics: Kinematics of the body.
            tick: Time between two poses, in [s].
        """
        super().__init__(tick)
        self.kinematics = kinematics

    def add(
        self,
        time: float,
        joints: Array,
        pose_support_in_odometry: Pose,
        left_supports: bool,
        tilt: tuple[float, float],
    ) -> None:
        """Store the state of a body that stands on one foot.

        Args:
            time: Time of the measurement, in [s].
            joints: Joint angles, in [rad]. Shape (joints,).
            pose_support_in_odometry: Pose of the stance foot.
            left_supports: Whether the stance foot is the left one.
            tilt: Roll and pitch of the torso, in [rad].
        """
        self._insert(
            time,
            partial(
                self.kinematics.pose,
                time,
                joints,
                pose_support_in_odometry,
                left_supports,
                tilt,
            ),
        )

    def add_level(
        self, time: float, joints: Array, pose_in_odometry: Pose
    ) -> None:
        """Store the state of a level body, midway between its feet.

        Args:
            time: Time of the measurement, in [s]; it may be earlier than the
                latest.
            joints: Joint angles, in [rad]. Shape (joints,).
            pose_in_odometry: Planar pose of the robot.
        """
        self._insert(
            time,
            partial(self.kinematics.level, time, joints, pose_in_odometry),
        )
