"""Roll and pitch of the torso from gyro and accelerometer."""

from math import atan2, cos, hypot, isnan, sin, tan

from ..core.constants import GRAVITY
from ..core.poses import Array

CALIBRATION = 1.0  # how long a robot stands to learn the bias, in [s]


class AttitudeFilter:
    """Complementary filter with an estimate of the gyro's bias.

    The gyro is integrated; the accelerometer, less what the pendulum is
    known to accelerate by, shows where up is and corrects the angles and,
    more slowly, the bias.

    Attributes:
        roll: About the torso's x axis, in [rad].
        pitch: About its y axis, in [rad].
        rate: Angular velocity without bias in the torso frame, in [rad/s].
    """

    def __init__(
        self,
        correction: float,
        bias_correction: float,
        *,
        calibration: float = CALIBRATION,
    ) -> None:
        """Begin standing still, and learn the bias.

        Args:
            correction: Rate at which the accelerometer is believed, [1/s].
            bias_correction: Its square for the bias, in [1/s^2].
            calibration: How long the robot stands to learn the bias, in
                [s]; 0 for one that moves at once and begins upright.
        """
        self._calibration = calibration
        self._correction, self._bias_correction = correction, bias_correction
        self.roll = self.pitch = 0.0
        self.rate = (0.0, 0.0, 0.0)
        self._bias = [0.0, 0.0]
        self._stood = 0.0
        self._sum = [0.0] * 5
        self._count = 0

    @property
    def ready(self) -> bool:
        """Whether the robot has stood long enough to know its bias."""
        return self._stood >= self._calibration

    def _calibrate(
        self, gyro: Array, specific_force: Array, duration: float
    ) -> None:
        """Average the readings of a robot that stands still."""
        self._stood += duration
        if self._stood < 0.3 * self._calibration:
            return  # still settling
        self._count += 1
        readings = (*gyro.tolist()[:2], *specific_force.tolist())
        self._sum = [a + b for a, b in zip(self._sum, readings, strict=True)]
        wx, wy, fx, fy, fz = (value / self._count for value in self._sum)
        self._bias = [wx, wy]
        self.roll = atan2(fy, fz)
        self.pitch = atan2(-fx, hypot(fy, fz))

    def update(
        self,
        gyro: Array,
        specific_force: Array,
        acceleration: tuple[float, float],
        duration: float,
    ) -> None:
        """Take one pair of readings.

        Args:
            gyro: Angular velocity in the torso frame, in [rad/s].
            specific_force: In the torso frame, in [m/s^2].
            acceleration: What the torso is known to accelerate by along its
                heading and to its left, in [m/s^2].
            duration: Time since the last one, in [s].
        """
        if not self.ready:
            self._calibrate(gyro, specific_force, duration)
            return
        wx, wy, wz = gyro.tolist()
        wz = 0.0 if isnan(wz) else wz  # a gyro with two axes
        wx, wy = wx - self._bias[0], wy - self._bias[1]
        self.rate = wx, wy, wz
        roll, pitch = self.roll, self.pitch
        sr, cr = sin(roll), cos(roll)
        roll += duration * (wx + tan(pitch) * (sr * wy + cr * wz))
        pitch += duration * (cr * wy - sr * wz)
        fx, fy, fz = specific_force.tolist()
        # Linear in the readings, so that shocks of landings, which average
        # to nothing, leave nothing behind.
        ax, ay = acceleration
        sr, cr, sp, cp = sin(roll), cos(roll), sin(pitch), cos(pitch)
        off_pitch = -(fx - (cp * ax - sp * GRAVITY)) / GRAVITY
        expected = sr * sp * ax + cr * ay + sr * cp * GRAVITY
        off_roll = (fy - expected) / GRAVITY
        if fx * fx + fy * fy + fz * fz > 1.0:
            gain = self._correction
            roll += gain * duration * off_roll
            pitch += gain * duration * off_pitch
            step = self._bias_correction * duration
            self._bias[0] -= step * off_roll
            self._bias[1] -= step * off_pitch
        self.roll, self.pitch = roll, pitch
