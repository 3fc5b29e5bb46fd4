"""Odometry of a walking robot from its stance foot and its gyro."""

from math import cos, sin

import numpy as np

from ...core.poses import Array, Pose
from ...perception.measurement import Measurement
from ...robots.forward_kinematics import ForwardKinematics

SMOOTHING = 0.1  # time constant of the velocity, in [s]: a few readings


class LegOdometry:
    """Pose of the torso over the floor, from the foot that carries it.

    Between two readings the foot with the greater force does not move; the
    torso moves by the opposite of that foot's motion in the torso frame.

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
        self.moved: Array = np.zeros(3)
        self.pose = Pose(0.0, 0.0, 0.0)
        self.velocity: Array = np.zeros(3)
        self._feet: Array | None = None

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
        posture = self._forward.posture(measurement.joint_positions)
        feet = posture.positions_feet_in_torso @ _tilted(*tilt).T
        forces = measurement.foot_forces
        stance = int(forces[4:].sum() > forces[:4].sum())
        x, y, theta = self.pose
        if self._feet is not None:
            c, s = cos(turn), sin(turn)
            now = feet[stance]
            moved = self._feet[stance] - (
                c * now[0] - s * now[1],
                s * now[0] + c * now[1],
                now[2],
            )
            moved = self._scale * moved
            self.moved = moved
            share = min(1.0, duration / SMOOTHING)
            self.velocity = self.velocity + share * (
                moved / duration - self.velocity
            )
            dx, dy = float(moved[0]), float(moved[1])
            x += cos(theta) * dx - sin(theta) * dy
            y += sin(theta) * dx + cos(theta) * dy
        self._feet = feet
        self.pose = Pose(x, y, theta + turn)


def _tilted(roll: float, pitch: float) -> Array:
    """Return the rotation from the torso to its level frame."""
    sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
    return np.array(
        [[cp, sp * sr, sp * cr], [0.0, cr, -sr], [-sp, cp * sr, cp * cr]]
    )
