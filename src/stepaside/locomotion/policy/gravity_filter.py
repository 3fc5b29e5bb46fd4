"""Direction of gravity in the torso frame, from gyro and accelerometer."""

from collections.abc import Sequence
from math import asin, atan2, cos, sin, sqrt

import numpy as np

from ...core.constants import GRAVITY
from ...core.poses import Array

CALIBRATION = 1.0  # of standing to average gravity, in [s]
SETTLED = 0.3  # share of it after which readings count
CORRECTION = 0.5  # gain of the accelerometer, in [1/s]: a few gait cycles
BIAS_CORRECTION = 0.05  # of the gyro bias, in [1/s^2]: damped beyond critical


class GravityFilter:
    r"""Complementary filter of the upward direction in the torso frame.

    The direction :math:`u` turns by the gyro, and towards the specific force
    :math:`f` by :math:`k \, (f \times u) / g`. The cross product leaves out
    the component of the acceleration along :math:`u`, so that vertical
    impacts that coincide with a swing of the torso do not tilt the estimate.
    The bias of the gyro follows from the same error, except about the
    vertical, where gravity shows none. A robot on a policy sways and turns
    slowly while it stands, so that standing does not calibrate its gyro.
    """

    def __init__(self) -> None:
        """Begin upright and uncalibrated."""
        self._up, self.rate = [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]
        self._bias = [0.0, 0.0, 0.0]
        self._force: Array = np.zeros(3)
        self._time, self._count = 0.0, 0

    @property
    def up(self) -> Array:
        """Upward unit vector in the torso frame. Shape (3,)."""
        return np.array(self._up)

    @property
    def ready(self) -> bool:
        """Whether the robot has stood long enough for the calibration."""
        return self._time >= CALIBRATION - 1e-9

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch of the torso, in [rad]."""
        x, y, z = self._up
        return atan2(y, z), -asin(min(1.0, max(-1.0, x)))

    def update(
        self,
        gyro: Array,
        specific_force: Array,
        acceleration: Sequence[float] | Array,
        duration: float,
    ) -> None:
        """Update the direction with one reading.

        Args:
            gyro: Angular velocity in the torso frame, in [rad/s]. Shape (3,).
            specific_force: Accelerometer in the torso frame, in [m/s^2].
                Shape (3,).
            acceleration: Known acceleration in the torso frame, in [m/s^2].
                Shape (3,).
            duration: Time since the last reading, in [s].
        """
        if not self.ready:
            self._calibrate(specific_force, duration)
            return
        # Floats one by one: arrays of three take five times as long.
        (p, q, r), (fx, fy, fz) = gyro.tolist(), specific_force.tolist()
        (ax, ay, az), (x, y, z) = acceleration, self._up
        bx, by, bz = self._bias
        if r != r:
            r = 0.0  # a gyro with two axes
        fx, fy = (fx - ax) / GRAVITY, (fy - ay) / GRAVITY
        fz = (fz - az) / GRAVITY
        ex, ey, ez = fy * z - fz * y, fz * x - fx * z, fx * y - fy * x
        p, q, r = p - bx, q - by, r - bz
        self.rate = [p, q, r]
        share = duration * BIAS_CORRECTION
        self._bias = [bx - share * ex, by - share * ey, bz - share * ez]
        p, q, r = p + CORRECTION * ex, q + CORRECTION * ey, r + CORRECTION * ez
        u = x + duration * (y * r - z * q)
        v = y + duration * (z * p - x * r)
        w = z + duration * (x * q - y * p)
        length = sqrt(u * u + v * v + w * w)
        self._up = [u / length, v / length, w / length]

    def adopt(self, tilt: tuple[float, float]) -> None:
        """Replace the direction by the estimate of the robot itself.

        It needs no calibration then.

        Args:
            tilt: Roll and pitch of the torso, in [rad].
        """
        roll, pitch = tilt
        c = cos(pitch)
        self._up = [-sin(pitch), c * sin(roll), c * cos(roll)]
        self._time = CALIBRATION

    def _calibrate(self, specific_force: Array, duration: float) -> None:
        """Average the direction of gravity of a robot that stands."""
        self._time += duration
        if self._time < SETTLED * CALIBRATION:
            return
        self._count += 1
        self._force = (
            self._force + (specific_force - self._force) / self._count
        )
        self._up = (self._force / np.linalg.norm(self._force)).tolist()
