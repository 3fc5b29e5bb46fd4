"""Tilt of the torso from gyro and accelerometer."""

from math import atan2, cos, hypot, sin, tan

from ..poses import Array

TRUST = 2.0  # time after which the accelerometer is believed, in [s]


class TiltFilter:
    """Complementary filter: the gyro quickly, gravity slowly."""

    def __init__(self) -> None:
        """Begin upright, as joint motion keeps the torso."""
        self._roll = self._pitch = 0.0
        self._time: float | None = None

    def update(
        self, time: float, gyro: Array, accelerometer: Array
    ) -> tuple[float, float]:
        """Tilt at a time.

        Args:
            time: Time of the measurement, in [s].
            gyro: Angular velocity in the torso, in [rad/s]. Shape (3,).
            accelerometer: Specific force there, in [m/s^2]. Shape (3,).

        Returns:
            Roll and pitch of the torso, in [rad].
        """
        ax, ay, az = accelerometer.tolist()
        roll, pitch = atan2(ay, az), atan2(-ax, hypot(ay, az))
        if self._time is None or az <= 0.0:
            self._time = time
            return self._roll, self._pitch
        step = time - self._time
        self._time = time
        p, q, r = gyro.tolist()
        c, s = cos(self._roll), sin(self._roll)
        self._roll += step * (p + (s * q + c * r) * tan(self._pitch))
        self._pitch += step * (c * q - s * r)
        share = min(1.0, step / TRUST)
        self._roll += share * (roll - self._roll)
        self._pitch += share * (pitch - self._pitch)
        return self._roll, self._pitch
