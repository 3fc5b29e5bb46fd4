"""Direction of gravity in the torso frame, from gyro and accelerometer."""

from math import asin, atan2, cos, sin, sqrt

import numpy as np

from ...core.compilation import bound, compiled
from ...core.constants import GRAVITY
from ...core.poses import Array

CALIBRATION = 1.0  # of standing, until the direction is known, in [s]
# Gain of the accelerometer until then, in [1/s]. It also reads the knocks of a
# robot that comes to stand: at 6 a K1 falls in its first steps, at 3 not.
FIRST = 3.0
# Gain afterwards, in [1/s]: some gait cycles. In walks at random commands on
# six networks the error is 0.5 to 0.6 deg rms, at 0.5 it is 0.8 to 1.1 deg.
# With sensors of the hardware body it is less at 0.25 than at 0.15 and 0.5.
CORRECTION = 0.25
BIAS_CORRECTION = 0.0125  # of the gyro, in [1/s^2]: damped beyond critical


@compiled
def follow_gravity(
    up: Array,
    turning: Array,
    bias: Array,
    gyro: Array,
    force: Array,
    velocity: Array,
    given: Array,
) -> None:
    """Update the direction with one reading; see :class:`GravityFilter`."""
    x, y, z = up[0], up[1], up[2]
    fx = (force[0] + velocity[1] * turning[0]) / GRAVITY
    fy = (force[1] - velocity[0] * turning[0]) / GRAVITY
    fz = force[2] / GRAVITY
    ex, ey, ez = fy * z - fz * y, fz * x - fx * z, fx * y - fy * x
    r = gyro[2] if gyro[2] == gyro[2] else 0.0
    p, q = gyro[0] - bias[0], gyro[1] - bias[1]
    duration, correction, share = given[0], given[1], given[0] * given[2]
    bias[0] -= share * ex
    bias[1] -= share * ey
    a, b, c = p + correction * ex, q + correction * ey, r + correction * ez
    u = x + duration * (y * c - z * b)
    v = y + duration * (z * a - x * c)
    w = z + duration * (x * b - y * a)
    length = sqrt(u * u + v * v + w * w)
    up[0], up[1], up[2] = u / length, v / length, w / length
    y, z = 0.5 * (y + up[1]), 0.5 * (z + up[2])
    turning[0] = (q * y + r * z) / (y * y + z * z)


class GravityFilter:
    r"""Complementary filter of the upward direction in the torso frame.

    The direction :math:`u` turns by the gyro, and towards the specific force
    :math:`f` by :math:`k \, (f \times u) / g`. The cross product leaves out
    the component of the acceleration along :math:`u`, so that vertical
    impacts that coincide with a swing of the torso do not tilt the estimate.
    The bias of the gyro follows from the same error, except about the axis
    near the vertical, where gravity shows none: what a torso that leans shows
    there is the sway of its walk. A robot on a policy sways and turns slowly
    while it stands, so that standing does not calibrate its gyro.

    The heading turns by the rate of the yaw angle, not by that about the axis
    of the torso: of a torso that rolls and pitches in step they differ in the
    mean.

    Attributes:
        up: Upward unit vector in the torso frame. Shape (3,).
        turning: Rate of the heading, in [rad/s]. Shape (1,).
    """

    def __init__(self, velocity: Array, duration: float) -> None:
        """Begin upright.

        Args:
            velocity: Velocity of the torso in its level frame, in [m/s],
                whose changes of direction are known accelerations; read at
                each update. Shape (3,).
            duration: Time between readings, in [s].
        """
        self.up, self.turning = np.array([0.0, 0.0, 1.0]), np.zeros(1)
        self._given, self._time = np.array([duration, FIRST, 0.0]), 0.0
        self._readings = np.zeros(3), np.zeros(3)
        self._follow = bound(
            *(
                follow_gravity,
                self.up,
                self.turning,
                np.zeros(2),
                *self._readings,
            ),
            *(velocity, self._given),
        )

    @property
    def ready(self) -> bool:
        """Whether the robot has stood long enough for the direction."""
        return self._time >= CALIBRATION - 1e-9

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch of the torso, in [rad]."""
        x, y, z = self.up.tolist()
        return atan2(y, z), -asin(min(1.0, max(-1.0, x)))

    def update(self, gyro: Array, specific_force: Array) -> None:
        """Update the direction with one reading.

        Args:
            gyro: Angular velocity in the torso frame, in [rad/s]; NaN about
                the vertical from a gyro with two axes. Shape (3,).
            specific_force: Accelerometer in the torso frame, in [m/s^2].
                Shape (3,).
        """
        if self.ready:
            self._given[1:] = CORRECTION, BIAS_CORRECTION
        self._time += self._given.item(0)
        self._readings[0][:], self._readings[1][:] = gyro, specific_force
        self._follow()

    def adopt(self, tilt: tuple[float, float]) -> None:
        """Replace the direction by the estimate of the robot itself.

        It is known at once then.

        Args:
            tilt: Roll and pitch of the torso, in [rad].
        """
        roll, pitch = tilt
        c = cos(pitch)
        self.up[:] = -sin(pitch), c * sin(roll), c * cos(roll)
        self._time = CALIBRATION
