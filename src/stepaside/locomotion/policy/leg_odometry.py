"""Odometry of a walking robot from its loaded soles and its gyro."""

from math import cos, sin

import numpy as np

from ...core.poses import Array, Pose
from ...perception.measurement import Measurement
from ...robots.forward_kinematics import ForwardKinematics

SMOOTHING = 0.1  # time constant of the velocity, in [s]: a few readings


class LegOdometry:
    """Pose of the torso over the floor, from the corners that carry it.

    A corner of a sole that is loaded at one reading does not move until the
    next, whether its foot lies flat, rolls or pivots. The torso moves by the
    opposite of the motion of these corners in the torso frame, the mean over
    all eight by their loads.

    Attributes:
        pose: Pose of the torso in odometry; its heading counts turns.
        moved: Motion over the last reading in the torso frame, in [m].
            Shape (3,).
        velocity: Velocity of the torso in its frame, smoothed, in [m/s].
            Shape (3,).
    """

    def __init__(self, forward: ForwardKinematics, scale: float = 1.0) -> None:
        """Begin at the origin.

        Args:
            forward: Kinematics of the robot.
            scale: True motion by that of the feet.
        """
        self._forward, self._scale = forward, scale
        corners = forward.force_sensors()
        self._corners_in_feet = np.zeros((2, 4, 3))
        self._corners_in_feet[..., :2] = corners.reshape(2, 4, 2)
        self.moved: Array = np.zeros(3)
        self.pose = Pose(0.0, 0.0, 0.0)
        self.velocity: Array = np.zeros(3)
        self._corners: Array = np.zeros((8, 3))
        self._loads: Array = np.zeros(8)

    def update(
        self,
        measurement: Measurement,
        tilt: tuple[float, float],
        turn: float,
        duration: float,
    ) -> None:
        """Advance by one reading.

        Args:
            measurement: Measurement with joint angles and foot forces.
            tilt: Roll and pitch of the torso, in [rad].
            turn: Rotation about the vertical since the last reading, in
                [rad].
            duration: Time since the last reading, in [s].
        """
        corners = self._locate(measurement.joint_positions) @ _tilted(*tilt).T
        before, loads = self._corners, self._loads
        self._corners, self._loads = corners, measurement.foot_forces.clip(0.0)
        load = float(loads.sum())
        if load > 0.0:
            c, s = cos(turn), sin(turn)
            turned = corners @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
            self.moved = self._scale * (loads @ (before - turned)) / load
        else:  # in flight
            self.moved = self.velocity * duration
        share = min(1.0, duration / SMOOTHING)
        self.velocity = self.velocity + share * (
            self.moved / duration - self.velocity
        )
        x, y, theta = self.pose
        dx, dy, _ = self.moved.tolist()
        x += cos(theta) * dx - sin(theta) * dy
        y += sin(theta) * dx + cos(theta) * dy
        self.pose = Pose(x, y, theta + turn)

    def _locate(self, joint_positions: Array) -> Array:
        """Return the corners of both soles in the torso frame, in [m]."""
        posture = self._forward.posture(joint_positions)
        axes = posture.axes_feet_in_torso.transpose(0, 2, 1)
        feet = posture.positions_feet_in_torso[:, None]
        return (feet + self._corners_in_feet @ axes).reshape(8, 3)


def _tilted(roll: float, pitch: float) -> Array:
    """Return the rotation from the torso to its level frame."""
    sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
    return np.array(
        [[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]]
    )
