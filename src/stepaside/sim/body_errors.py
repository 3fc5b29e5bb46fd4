"""Errors of sensors and masses of a body, like those of real ones."""

from collections import deque
from collections.abc import Iterator
from math import atan2, sqrt

import mujoco
import numpy as np

from ..core.compilation import bound, compiled
from ..core.poses import Array
from .body_settings import BodySettings


@compiled
def integrate_motion(
    quaternion: Array,
    velocity: Array,
    spin: Array,
    place: Array,
    gravity: Array,
    last: Array,
    means: Array,
    now: float,
) -> None:
    """Set mean rate, mean specific force and rate; see :class:`StrapdownImu`.

    ``means`` (3, 3) are in the frame of the torso. ``last`` are time,
    quaternion, axes and velocity of the IMU of the last call, with a negative
    time before the first.
    """
    w, x, y, z = quaternion[0], quaternion[1], quaternion[2], quaternion[3]
    axes = np.empty((3, 3))
    axes[0, 0], axes[0, 1] = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z)
    axes[0, 2], axes[1, 0] = 2.0 * (x * z + w * y), 2.0 * (x * y + w * z)
    axes[1, 1], axes[1, 2] = 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    axes[2, 0], axes[2, 1] = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x)
    axes[2, 2] = 1.0 - 2.0 * (x * x + y * y)
    u = spin[1] * place[2] - spin[2] * place[1]
    v = spin[2] * place[0] - spin[0] * place[2]
    h = spin[0] * place[1] - spin[1] * place[0]
    for k in range(3):
        means[0, k] = means[2, k] = spin[k]
        means[1, k] = 0.0
    passed = now - last[0]
    moved = last[0] >= 0.0 and passed > 0.0
    if moved:
        a, b, c, d = last[1], last[2], last[3], last[4]
        cosine = a * w + b * x + c * y + d * z
        side = -1.0 if cosine < 0.0 else 1.0
        turn_x = side * (a * x - b * w - c * z + d * y)
        turn_y = side * (a * y + b * z - c * w - d * x)
        turn_z = side * (a * z - b * y + c * x - d * w)
        sine = sqrt(turn_x * turn_x + turn_y * turn_y + turn_z * turn_z)
        half = atan2(sine, side * cosine)
        rate = 2.0 * (half / sine if sine > 0.0 else 1.0) / passed
        means[0, 0], means[0, 1] = rate * turn_x, rate * turn_y
        means[0, 2] = rate * turn_z
    for i in range(3):
        own = velocity[i] + axes[i, 0] * u + axes[i, 1] * v + axes[i, 2] * h
        change = (own - last[14 + i]) / passed if moved else 0.0
        for k in range(3):
            before = last[5 + 3 * i + k] if moved else axes[i, k]
            between = 0.5 * (before + axes[i, k])
            means[1, k] += (change - gravity[i]) * between
            last[5 + 3 * i + k] = axes[i, k]
        last[14 + i] = own
    last[0], last[1], last[2], last[3], last[4] = now, w, x, y, z


class StrapdownImu:
    """Gyro and accelerometer that integrate between readings, as real ones do.

    One sample per tick would alias landing impacts: half a degree of tilt.
    The means follow from the change of orientation and velocity of the torso.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, root: int, site: int
    ) -> None:
        joint = model.body_jntadr[root]
        at, dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        self._data, self._means = data, np.zeros((3, 3))
        mount = np.zeros(9)
        mujoco.mju_quat2Mat(mount, model.site_quat[site])
        self._mount = mount.reshape(3, 3)
        last = np.zeros(17)
        last[0] = -1.0
        self._integrate = bound(
            integrate_motion,
            *(data.qpos[at + 3 : at + 7], data.qvel[dof : dof + 3]),
            *(data.qvel[dof + 3 : dof + 6], model.site_pos[site].copy()),
            *(model.opt.gravity.copy(), last, self._means),
            more=(0.0,),
        )

    def read(self) -> tuple[Array, Array, Array]:
        """Return mean rate and specific force since the last call, and rate.

        They are in the frame of the IMU, in [rad/s] and [m/s^2].
        """
        self._integrate(self._data.time)
        mean, force, latest = self._means.dot(self._mount)
        return mean, force, latest


BLOCK = 64  # readings whose noise is drawn together


class SensorErrors:
    """Noise, bias, resolution and delay of the sensors of one robot."""

    def __init__(
        self,
        body: BodySettings,
        generator: np.random.Generator,
        *,
        force_unit: float = 1.0,
    ) -> None:
        self._body = body
        self._generator = generator
        # Of gyro, then accelerometer.
        self._imu_bias = np.repeat(
            (body.gyro_bias, body.accelerometer_bias), 3
        ) * generator.uniform(-1, 1, 6)
        self._deviations = np.repeat(
            (
                body.gyro_noise,
                body.accelerometer_noise,
                body.force_noise * force_unit,
            ),
            (3, 3, 8),
        )
        # Noise of coming readings; drawn together as if one by one.
        self._noise: Iterator[Array] = iter(())
        self._gains = 1.0 + body.force_gain_error * generator.uniform(-1, 1, 8)
        self._last: tuple[float, Array] | None = None
        self._imu: deque[tuple[Array, Array, Array]] = deque(
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

    def velocities(self, exact: Array, angles: Array, now: float) -> Array:
        """Return velocities [rad/s] as the change of the quantised angles."""
        last, self._last = self._last, (now, angles)
        if self._body.encoder_step == 0.0 or last is None or now <= last[0]:
            return exact
        changed: Array = (angles - last[1]) / (now - last[0])
        return changed

    def readings(
        self, gyro: Array, force: Array, latest: Array, foot_forces: Array
    ) -> tuple[Array, Array, Array, Array]:
        """Return rate, specific force, latest rate, foot forces, all noisy."""
        noise = next(self._noise, None)
        if noise is None:
            drawn = self._generator.standard_normal((BLOCK, 14))
            self._noise = iter(drawn * self._deviations)
            noise = next(self._noise)
        readings = np.concatenate((gyro, force))
        readings += self._imu_bias
        readings += noise[:6]
        latest = latest + readings[:3] - gyro
        self._imu.append((readings[:3], readings[3:], latest))
        noisy = foot_forces * self._gains
        noisy += noise[6:]
        return *self._imu[0], np.maximum(noisy, 0.0, out=noisy)


def perturb_masses(
    spec_bodies: object,
    body: BodySettings,
    torso: str,
    generator: np.random.Generator,
    *,
    length_unit: float = 1.0,
) -> None:
    """Perturb masses, and the CoM of the torso in units of NAO's size."""
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
