"""Direction of gravity in the torso frame, from gyro and accelerometer."""

from math import asin, atan2, cos, hypot, sin, sqrt

import numpy as np

from ..core.compilation import bound, compiled
from ..core.constants import GRAVITY
from ..core.poses import Array

CALIBRATION = 1.0  # standing time to estimate the gyro bias, in [s]


@compiled
def attitude_step(
    up: Array,
    bias: Array,
    rate: Array,
    turning: Array,
    gyro: Array,
    force: Array,
    gains: Array,
    ahead: float,
    left: float,
    duration: float,
) -> None:
    """Update direction, bias, rate and turn; see :class:`AttitudeFilter`.

    The known acceleration is along the heading and to the left; ``gains`` are
    those of direction and bias.
    """
    x, y, z = up[0], up[1], up[2]
    p, q = gyro[0] - bias[0], gyro[1] - bias[1]
    r = gyro[2] if gyro[2] == gyro[2] else 0.0  # a gyro with two axes
    cp = max(sqrt(y * y + z * z), 1e-9)
    sr, cr, sp = y / cp, z / cp, -x
    fx = (force[0] - cp * ahead) / GRAVITY
    fy = (force[1] - sr * sp * ahead - cr * left) / GRAVITY
    fz = (force[2] - cr * sp * ahead + sr * left) / GRAVITY
    felt = force[0] ** 2 + force[1] ** 2 + force[2] ** 2
    seen = 1.0 if felt > 1.0 else 0.0  # not in free fall
    ex, ey, ez = fy * z - fz * y, fz * x - fx * z, fx * y - fy * x
    correction = seen * gains[0]
    share = seen * duration * gains[1]
    bias[0] -= share * ex
    bias[1] -= share * ey
    a, b, c = p + correction * ex, q + correction * ey, r + correction * ez
    u = x + duration * (y * c - z * b)
    v = y + duration * (z * a - x * c)
    w = z + duration * (x * b - y * a)
    length = sqrt(u * u + v * v + w * w)
    up[0], up[1], up[2] = u / length, v / length, w / length
    rate[0], rate[1], rate[2] = p, q, r
    y, z = 0.5 * (y + up[1]), 0.5 * (z + up[2])
    turning[0] = (q * y + r * z) / max(y * y + z * z, 1e-9)


class AttitudeFilter:
    r"""Complementary filter of the upward direction in the torso frame.

    The direction :math:`u` turns by the gyro, and towards the specific force
    :math:`f`, less a known acceleration, by :math:`k \, (f \times u) / g`.
    The cross product leaves out the component of the acceleration along
    :math:`u`: vertical impacts in step with a swing of the torso do not tilt
    the estimate. The bias follows from the same error, except near the
    vertical. The heading turns by the rate of the yaw angle, which differs in
    the mean from that about the axis of a torso that rolls and pitches.
    """

    def __init__(
        self,
        correction: float,
        bias_correction: float,
        *,
        calibration: float = CALIBRATION,
    ) -> None:
        """Start uncalibrated, with gains of direction [1/s] and bias [1/s^2].

        The robot stands still for the calibration [s]; one with 0 starts
        upright and moves at once.
        """
        self._calibration = calibration
        self.gains = np.array([correction, bias_correction])
        self.up, self.turning = np.array([0.0, 0.0, 1.0]), np.zeros(1)
        self._bias, self._rate = np.zeros(2), np.zeros(3)
        self._gyro, self._force = np.zeros(3), np.zeros(3)
        self._step = bound(
            *(attitude_step, self.up, self._bias, self._rate, self.turning),
            *(self._gyro, self._force, self.gains),
            more=(0.0, 0.0, 0.0),
        )
        self._time_standing = 0.0
        self._sum, self._count = np.zeros(5), 0

    @property
    def ready(self) -> bool:
        """Whether the bias is calibrated."""
        return self._time_standing >= self._calibration

    @property
    def roll(self) -> float:
        """Angle about the x axis of the torso, in [rad]."""
        return atan2(self.up.item(1), self.up.item(2))

    @property
    def pitch(self) -> float:
        """Angle about its y axis, in [rad]."""
        return -asin(min(1.0, max(-1.0, self.up.item(0))))

    @property
    def rate(self) -> tuple[float, float, float]:
        """Angular velocity in the torso frame, bias removed, in [rad/s]."""
        x, y, z = self._rate.tolist()
        return x, y, z

    def lean(self, roll: float, pitch: float) -> None:
        """Set the direction by roll and pitch, in [rad]."""
        c = cos(pitch)
        self.up[:] = -sin(pitch), c * sin(roll), c * cos(roll)

    def _calibrate(
        self, gyro: Array, specific_force: Array, duration: float
    ) -> None:
        """Average the readings of a robot that stands still."""
        self._time_standing += duration
        if self._time_standing < 0.3 * self._calibration:
            return  # the robot still settles after its start
        self._count += 1
        self._sum += np.concatenate((gyro[:2], specific_force))
        wx, wy, fx, fy, fz = (self._sum / self._count).tolist()
        self._bias[:] = wx, wy
        self.lean(atan2(fy, fz), atan2(-fx, hypot(fy, fz)))

    def update(
        self,
        gyro: Array,
        specific_force: Array,
        acceleration: tuple[float, float],
        duration: float,
    ) -> None:
        """Update with a reading of the IMU.

        The rate about the vertical is NaN from a gyro with two axes; the
        known acceleration [m/s^2] is along the heading and to its left.
        """
        if not self.ready:
            self._calibrate(gyro, specific_force, duration)
            return
        self._gyro[:], self._force[:] = gyro, specific_force
        self._step(*acceleration, duration)
