"""What encoders, IMU and foot sensors make of the truth."""

from collections import deque

import mujoco
import numpy as np

from ..core.poses import Array
from .body_settings import BodySettings


class AveragedImu:
    """Gyro and accelerometer averaged from one reading to the next.

    Read once in a control tick alone they would alias the shocks of
    landings, which comes out as a tilt of half a degree.
    """

    def __init__(
        self, data: mujoco.MjData, gyro: slice, accelerometer: slice
    ) -> None:
        """Watch two sensors of a world."""
        self._sensors = data.sensordata
        self._gyro, self._accelerometer = gyro, accelerometer
        self._sum = np.zeros(6)
        self._count = 0

    def before_step(self, time: float) -> None:
        """Take the readings of the last physics step."""
        self._sum[:3] += self._sensors[self._gyro]
        self._sum[3:] += self._sensors[self._accelerometer]
        self._count += 1

    def read(self) -> tuple[Array, Array]:
        """Means since the last reading, in [rad/s] and [m/s^2]."""
        if self._count == 0:
            self.before_step(0.0)
        mean = self._sum / self._count
        self._sum[:] = 0.0
        self._count = 0
        return mean[:3], mean[3:]


class SensorErrors:
    """Noise, bias, resolution and lag of one robot's sensors."""

    def __init__(
        self,
        body: BodySettings,
        generator: np.random.Generator,
        *,
        force_unit: float = 1.0,
    ) -> None:
        """Draw the constant errors of one robot.

        Args:
            body: Size of the errors.
            generator: Of the errors.
            force_unit: Force of the robot for one of NAO's.
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
        """Joint angles as encoded, in [rad]. Shape (joints,)."""
        step = self._body.encoder_step
        return angles if step == 0.0 else np.round(angles / step) * step

    def imu(self, gyro: Array, force: Array) -> tuple[Array, Array]:
        """Angular velocity [rad/s] and specific force [m/s^2], late."""
        body, draw = self._body, self._generator.standard_normal
        gyro = gyro + self._gyro_bias + body.gyro_noise * draw(3)
        force = force + self._specific_force_bias
        force += body.accelerometer_noise * draw(3)
        self._imu.append((gyro, force))
        return self._imu[0]

    def foot_forces(self, forces: Array) -> Array:
        """Pressing forces, in [N], never below zero. Shape (8,)."""
        noise = self._force_noise * self._generator.standard_normal(8)
        spoilt: Array = np.maximum(forces * self._gains + noise, 0.0)
        return spoilt


def perturb_masses(
    spec_bodies: object,
    body: BodySettings,
    torso: str,
    generator: np.random.Generator,
    *,
    length_unit: float = 1.0,
) -> None:
    """Give a robot's links other masses than its description has.

    Args:
        spec_bodies: Bodies of a MuJoCo specification.
        body: Size of the errors.
        torso: Name of the torso, whose CoM is shifted.
        generator: Of the errors.
        length_unit: Length of the robot for one of NAO's.
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
