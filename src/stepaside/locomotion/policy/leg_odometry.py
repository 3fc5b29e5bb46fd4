"""Odometry of a walking robot from its loaded soles and its gyro."""

from math import atan2, cos, sin

import numpy as np

from ...core.poses import Array, Pose
from ...perception.measurement import Measurement
from ...planning import Foot
from ...robots.forward_kinematics import ForwardKinematics, MeasuredPosture

SMOOTHING = 0.1  # time constant of the velocity, in [s]: a few readings


class LegOdometry:
    """Pose of the CoM over the floor, from the corners that carry it.

    A corner of a sole that is loaded at one reading does not move until the
    next, whether its foot lies flat, rolls or pivots. The torso moves by the
    opposite of the motion of these corners in the torso frame, the mean over
    all eight by their loads. The CoM, which is the reference point of a
    walking robot, moves as the joints say in addition.

    Attributes:
        pose: Pose in odometry: place of the CoM, and heading of the torso,
            which counts turns.
        moved: Motion of the CoM over the last reading, ahead and to the left
            at the mean heading, in [m]. Shape (2,).
        velocity: Velocity of the torso in its level frame, smoothed, in
            [m/s]. Shape (3,).
    """

    def __init__(
        self, forward: ForwardKinematics, joint_positions: Array
    ) -> None:
        """Begin at the origin.

        Args:
            forward: Kinematics of the robot.
            joint_positions: Initial joint angles, in [rad]. Shape (joints,).
        """
        self._forward = forward
        self._corners_in_feet = np.zeros((2, 4, 3))
        self._corners_in_feet[..., :2] = forward.force_sensors().reshape(
            2, 4, 2
        )
        self.moved: Array = np.zeros(2)
        self.pose = Pose(0.0, 0.0, 0.0)
        self.velocity: Array = np.zeros(3)
        self._points: Array = np.zeros((9, 3))
        self._loads: Array = np.zeros(8)
        self._posture = forward.posture(joint_positions)
        self._level: Array = np.eye(3)

    @property
    def stance(self) -> tuple[Pose, Foot]:
        """Pose in odometry of the foot with the greater load, and its side.

        Its sole is taken for level.
        """
        left, right = self._loads.reshape(2, 4).sum(axis=1).tolist()
        side = Foot.LEFT if left >= right else Foot.RIGHT
        i = 0 if side is Foot.LEFT else 1
        posture, level = self._posture, self._level
        ahead = level @ posture.axes_feet_in_torso[i, :, 0]
        place = level @ (
            posture.positions_feet_in_torso[i] - posture.position_com_in_torso
        )
        yaw = atan2(ahead[1], ahead[0])
        return self.pose.compose(Pose(place[0], place[1], yaw)), side

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
        self._posture = self._forward.posture(measurement.joint_positions)
        self._level = _tilted(*tilt)
        points = self._locate(self._posture) @ self._level.T
        c, s = cos(0.5 * turn), sin(0.5 * turn)
        onward = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        shifts = points @ onward - self._points @ onward.T
        loads = self._loads
        self._points, self._loads = points, measurement.foot_forces.clip(0.0)
        load = float(loads.sum())
        if load > 0.0:
            torso = -(loads @ shifts[:8]) / load
            self.moved = (torso + shifts[8])[:2]
        else:  # in flight, or no reading before
            torso = self.velocity * duration
            self.moved = torso[:2]
        share = min(1.0, duration / SMOOTHING)
        self.velocity = self.velocity + share * (
            torso / duration - self.velocity
        )
        x, y, theta = self.pose
        dx, dy = self.moved.tolist()
        c, s = cos(theta + 0.5 * turn), sin(theta + 0.5 * turn)
        x += c * dx - s * dy
        y += s * dx + c * dy
        self.pose = Pose(x, y, theta + turn)

    def _locate(self, posture: MeasuredPosture) -> Array:
        """Return the corners of both soles and the CoM in the torso frame."""
        axes = posture.axes_feet_in_torso.transpose(0, 2, 1)
        feet = posture.positions_feet_in_torso[:, None]
        corners = (feet + self._corners_in_feet @ axes).reshape(8, 3)
        return np.vstack([corners, posture.position_com_in_torso])


def _tilted(roll: float, pitch: float) -> Array:
    """Return the rotation from the torso to its level frame."""
    sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
    return np.array(
        [[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]]
    )
