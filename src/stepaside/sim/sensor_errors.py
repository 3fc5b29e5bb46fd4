"""Errors of encoders, IMU, foot sensors and of the mass model."""

from collections import deque

import mujoco
import numpy as np

from ..core.poses import Array
from .body_settings import BodySettings


class AveragedImu:
    """Gyro and accelerometer averaged between readings.

    One sample per control tick would alias landing impacts, which causes an
    error of half a degree in the estimated tilt.
    """

    def __init__(
        self, data: mujoco.MjData, gyro: slice, accelerometer: slice
    ) -> None:
        """Average two sensors of a world."""
        self._gyro: Array = data.sensordata[gyro]  # views
        self._accelerometer: Array = data.sensordata[accelerometer]
        self._gyro_sum, self._accelerometer_sum = np.zeros(3), np.zeros(3)
        self._count = 0

    def before_step(self, time: float) -> None:
        """Add the readings of the last physics step."""
        self._gyro_sum += self._gyro
        self._accelerometer_sum += self._accelerometer
        self._count += 1

    def read(self) -> tuple[Array, Array]:
        """Return the means since the last call, in [rad/s] and [m/s^2]."""
        if self._count == 0:
            self.before_step(0.0)
        gyro = self._gyro_sum / self._count
        accelerometer = self._accelerometer_sum / self._count
        self._gyro_sum.fill(0.0)
        self._accelerometer_sum.fill(0.0)
        self._count = 0
        return gyro, accelerometer


class SensorErrors:
    """Noise, bias, resolution and delay of the sensors of one robot."""

    def __init__(
        self,
        body: BodySettings,
        generator: np.random.Generator,
        *,
        force_unit: float = 1.0,
    ) -> None:
        """Draw the constant errors of one robot.

        Args:
            body: Magnitudes of the errors.
            generator: Random generator of the errors.
            force_unit: Weight of the robot relative to NAO's.
        """
        self._body = body
        self._force_noise = body.force_noise * force_unit  # in [N]
        self._generator = generator
        self._gyro_bias = body.gyro_bias * generator.uniform(-1, 1, 3)
        self._specific_force_bias = (
            body.accelerometer_bias * generator.uniform(-1, 1, 3)
        )
        self._gains = 1.0 + body.force_gain_error * generator.uniform(-1, 1, 8)
        self._imu: deque[tuple[Array, Array]] = deque(
            maxlen=body.imu_delay_cycles + 1
        )

    def encoders(self, angles: Array) -> Array:
        """Return quantised joint angles, in [rad]. Shape (joints,)."""
        step = self._body.encoder_step
        return angles if step == 0.0 else np.rint(angles / step) * step

    def imu(self, gyro: Array, force: Array) -> tuple[Array, Array]:
        """Return noisy, delayed gyro [rad/s] and accelerometer [m/s^2]."""
        body, draw = self._body, self._generator.standard_normal
        gyro = gyro + self._gyro_bias + body.gyro_noise * draw(3)
        force = force + self._specific_force_bias
        force += body.accelerometer_noise * draw(3)
        self._imu.append((gyro, force))
        return self._imu[0]

    def foot_forces(self, forces: Array) -> Array:
        """Return noisy normal forces, in [N], at least zero. Shape (8,)."""
        noise = self._force_noise * self._generator.standard_normal(8)
        noisy: Array = np.maximum(forces * self._gains + noise, 0.0)
        return noisy


def perturb_masses(
    spec_bodies: object,
    body: BodySettings,
    torso: str,
    generator: np.random.Generator,
    *,
    length_unit: float = 1.0,
) -> None:
    """Perturb the masses of the links of a robot in place.

    Args:
        spec_bodies: Bodies of a MuJoCo specification.
        body: Magnitudes of the errors.
        torso: Name of the torso, whose CoM is shifted.
        generator: Random generator of the errors.
        length_unit: Size of the robot relative to NAO's.
    """
    for part in spec_bodies:  # type: ignore[attr-defined]
        error = generator.uniform(-1, 1)
        shift = generator.uniform(-1, 1, 2)
        if not part.mass > 0.0:
            continue
        factor = 1.0 + body.mass_error * error
        part.mass *= factor
        part.fullinertia *= factor
        part.inertia *= factor
        if part.name == torso:
            part.ipos[:2] += body.com_error * length_unit * shift
