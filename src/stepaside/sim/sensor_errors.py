"""Errors of encoders, IMU, foot sensors and of the mass model."""

from collections import deque
from math import atan2, sqrt

import mujoco
import numpy as np

from ..core.machine_code import BoundKernel, kernel_of
from ..core.poses import Array
from .body_settings import BodySettings

LOOP = """\
def add_readings(gyro, accelerometer, last, sums):
    for i in range(3):
        sums[i] += last[i] if last[3] > 0.0 else gyro[i]
        sums[3 + i] += accelerometer[i]
        last[i] = gyro[i]
    last[3] = 1.0
    sums[6] += 1.0
"""


class AveragedImu:
    """Gyro and accelerometer averaged between readings.

    One sample per control tick would alias landing impacts, which causes an
    error of half a degree in the estimated tilt.

    Attributes:
        kernel: :meth:`before_step` as machine code, if it is used, to be
            called after the gyro of the present step is known.
    """

    def __init__(
        self, data: mujoco.MjData, gyro: slice, accelerometer: slice
    ) -> None:
        """Average two sensors of a world."""
        self._gyro: Array = data.sensordata[gyro]  # views
        self._accelerometer: Array = data.sensordata[accelerometer]
        # Sums of gyro and accelerometer, and their number.
        self._sums = np.zeros(7)
        # Gyro of the last physics step, and whether there was one.
        self._last = np.zeros(4)
        self.kernel: BoundKernel | None = None
        average = kernel_of("add_readings", LOOP, "1111")
        if average is not None:
            self.kernel = average.bind(
                *(self._gyro, self._accelerometer, self._last, self._sums)
            )

    def before_step(self, time: float) -> None:
        """Add the readings of the last physics step."""
        self._sums[:3] += self._gyro
        self._sums[3:6] += self._accelerometer
        self._sums[6] += 1.0

    def read(self) -> tuple[Array, Array]:
        """Return the means since the last call, in [rad/s] and [m/s^2]."""
        if self._sums[6] == 0.0:
            self.before_step(0.0)
        means = self._sums[:6] / self._sums[6]
        self._sums.fill(0.0)
        return means[:3], means[3:]


class StrapdownImu:
    """Gyro and accelerometer that integrate between readings.

    The means follow from the change of orientation and velocity of the torso
    over the whole interval, as an IMU with delta angles and delta velocities
    gives them. Nothing has to be read in between.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, root: int, site: int
    ) -> None:
        """Integrate from the present state.

        Args:
            model: Compiled model.
            data: Its state.
            root: Body with the free joint, on which the IMU is.
            site: Site of the IMU.
        """
        joint = model.body_jntadr[root]
        at, dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        self._quaternion: Array = data.qpos[at + 3 : at + 7]  # views
        self._velocity: Array = data.qvel[dof : dof + 3]
        self._rate: Array = data.qvel[dof + 3 : dof + 6]
        self._data = data
        self._gravity: Array = model.opt.gravity.copy()
        self._place: list[float] = model.site_pos[site].tolist()
        self._axes: Array = axes_of(model.site_quat[site].tolist())
        self._last: tuple[float, Array, Array, Array] | None = None

    def read(self) -> tuple[Array, Array, Array]:
        """Return mean rate and specific force since the last call, and rate.

        Returns:
            Mean angular velocity, in [rad/s], and mean specific force, in
            [m/s^2], since the last call, and the present angular velocity, in
            the frame of the IMU. Shape (3,) each.
        """
        now, quaternion = self._data.time, self._quaternion.copy()
        torso = axes_of(quaternion.tolist())
        (a, b, c), (x, y, z) = self._rate.tolist(), self._place
        swing = np.array([b * z - c * y, c * x - a * z, a * y - b * x])
        velocity = self._velocity + torso @ swing
        rate = self._rate.copy()
        mean, force = rate, -self._gravity @ torso
        if self._last is not None and now > self._last[0]:
            before, last, axes, moved = self._last
            mean = turn_between(last, quaternion) / (now - before)
            change = (velocity - moved) / (now - before) - self._gravity
            force = 0.5 * (change @ (axes + torso))
        self._last = now, quaternion, torso, velocity
        return mean @ self._axes, force @ self._axes, rate @ self._axes


def axes_of(quaternion: list[float]) -> Array:
    """Return the rotation matrix of a unit quaternion (w, x, y, z)."""
    w, x, y, z = quaternion
    xx, yy, zz = x * x, y * y, z * z
    xy, xz, yz = x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    return np.array(
        [
            [1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)],
            [2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)],
            [2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)],
        ]
    )


def turn_between(first: Array, second: Array) -> Array:
    """Return the rotation vector between two orientations, in [rad].

    Args:
        first: Unit quaternion (w, x, y, z) of a frame.
        second: That of the frame into which it turns, in less than a turn.

    Returns:
        Axis times angle, in either frame. Shape (3,).
    """
    (a, b, c, d), (w, x, y, z) = first.tolist(), second.tolist()
    cosine = a * w + b * x + c * y + d * z
    sine = np.array(
        [
            a * x - b * w - c * z + d * y,
            a * y + b * z - c * w - d * x,
            a * z - b * y + c * x - d * w,
        ]
    )
    if cosine < 0.0:
        cosine, sine = -cosine, -sine
    half = atan2(sqrt(sine.dot(sine)), cosine)
    # half / sin(half), without dividing by half = 0
    turn: Array = 2.0 * sine / np.sinc(half / np.pi)
    return turn


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
        # Of gyro, then accelerometer.
        self._imu_bias = np.repeat(
            (body.gyro_bias, body.accelerometer_bias), 3
        ) * generator.uniform(-1, 1, 6)
        self._imu_noise = np.repeat(
            (body.gyro_noise, body.accelerometer_noise), 3
        )
        self._gains = 1.0 + body.force_gain_error * generator.uniform(-1, 1, 8)
        self._imu: deque[tuple[Array, Array]] = deque(
            maxlen=body.imu_delay_cycles + 1
        )

    def encoders(self, angles: Array) -> Array:
        """Return quantised joint angles, in [rad]. Shape (joints,)."""
        step = self._body.encoder_step
        if step == 0.0:
            return angles
        steps = angles / step
        np.rint(steps, out=steps)
        steps *= step
        return steps

    def imu(self, gyro: Array, force: Array) -> tuple[Array, Array]:
        """Return noisy, delayed gyro [rad/s] and accelerometer [m/s^2]."""
        readings = np.concatenate((gyro, force))
        readings += self._imu_bias
        readings += self._imu_noise * self._generator.standard_normal(6)
        self._imu.append((readings[:3], readings[3:]))
        return self._imu[0]

    def foot_forces(self, forces: Array) -> Array:
        """Return noisy normal forces, in [N], at least zero. Shape (8,)."""
        noisy = forces * self._gains
        noisy += self._force_noise * self._generator.standard_normal(8)
        return np.maximum(noisy, 0.0, out=noisy)


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
