"""Roll and pitch of the torso from gyro and accelerometer."""

from math import atan2, cos, hypot, isnan, sin, tan

from ..core.constants import GRAVITY
from ..core.poses import Array

CALIBRATION = 1.0  # standing time to estimate the gyro bias, in [s]


class AttitudeFilter:
    """Complementary filter of roll and pitch with a gyro bias estimate.

    The gyro is integrated. The accelerometer, less the known acceleration of
    the pendulum, measures the direction of gravity and corrects the angles
    and, more slowly, the bias.

    Attributes:
        roll: Angle about the x axis of the torso, in [rad].
        pitch: Angle about its y axis, in [rad].
        rate: Angular velocity in the torso frame, bias removed, in [rad/s].
        bias: Bias of the gyro about the x and y axes, in [rad/s].
        gains: Gains of the corrections of angles, in [1/s], and of the bias,
            in [1/s^2].
    """

    def __init__(
        self,
        correction: float,
        bias_correction: float,
        *,
        calibration: float = CALIBRATION,
    ) -> None:
        """Start uncalibrated, for a robot that stands still.

        Args:
            correction: Gain of the angle correction, in [1/s].
            bias_correction: Gain of the bias correction, in [1/s^2].
            calibration: Standing time to estimate the bias, in [s]; 0 for a
                robot that starts upright and moves at once.
        """
        self._calibration = calibration
        self.gains = correction, bias_correction
        self.roll = self.pitch = 0.0
        self.rate = (0.0, 0.0, 0.0)
        self.bias = [0.0, 0.0]
        self._time_standing = 0.0
        self._sum = [0.0] * 5
        self._count = 0

    @property
    def ready(self) -> bool:
        """Whether the bias is calibrated."""
        return self._time_standing >= self._calibration

    def _calibrate(
        self, gyro: Array, specific_force: Array, duration: float
    ) -> None:
        """Average the readings of a robot that stands still."""
        self._time_standing += duration
        if self._time_standing < 0.3 * self._calibration:
            return  # the robot still settles after its start
        self._count += 1
        readings = (*gyro.tolist()[:2], *specific_force.tolist())
        self._sum = [a + b for a, b in zip(self._sum, readings, strict=True)]
        wx, wy, fx, fy, fz = (value / self._count for value in self._sum)
        self.bias = [wx, wy]
        self.roll = atan2(fy, fz)
        self.pitch = atan2(-fx, hypot(fy, fz))

    def update(
        self,
        gyro: Array,
        specific_force: Array,
        acceleration: tuple[float, float],
        duration: float,
    ) -> None:
        """Update the angles with one reading of the IMU.

        Args:
            gyro: Angular velocity in the torso frame, in [rad/s].
            specific_force: Accelerometer in the torso frame, in [m/s^2].
            acceleration: Known acceleration of the torso along its heading
                and to its left, in [m/s^2].
            duration: Time since the last reading, in [s].
        """
        if not self.ready:
            self._calibrate(gyro, specific_force, duration)
            return
        wx, wy, wz = gyro.tolist()
        wz = 0.0 if isnan(wz) else wz  # a gyro with two axes
        wx, wy = wx - self.bias[0], wy - self.bias[1]
        self.rate = wx, wy, wz
        roll, pitch = self.roll, self.pitch
        sr, cr = sin(roll), cos(roll)
        roll += duration * (wx + tan(pitch) * (sr * wy + cr * wz))
        pitch += duration * (cr * wy - sr * wz)
        fx, fy, fz = specific_force.tolist()
        # Linear in the readings, so that landing impacts, whose mean is zero,
        # leave no error.
        ax, ay = acceleration
        sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
        error_pitch = -(fx - (cp * ax - sp * GRAVITY)) / GRAVITY
        expected = sr * sp * ax + cr * ay + sr * cp * GRAVITY
        error_roll = (fy - expected) / GRAVITY
        if fx * fx + fy * fy + fz * fz > 1.0:
            gain, bias_gain = self.gains
            roll += gain * duration * error_roll
            pitch += gain * duration * error_pitch
            step = bias_gain * duration
            self.bias[0] -= step * error_roll
            self.bias[1] -= step * error_pitch
        self.roll, self.pitch = roll, pitch
