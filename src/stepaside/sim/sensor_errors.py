"""Errors of encoders, IMU, foot sensors and of the mass model."""

from collections import deque
from collections.abc import Iterator
from math import atan2, sqrt

import mujoco
import numpy as np

from ..core.compilation import bound, compiled
from ..core.poses import Array
from .body_settings import BodySettings


@compiled
def strapdown(
    quaternion: Array,
    velocity: Array,
    spin: Array,
    place: Array,
    mount: Array,
    gravity: Array,
    clock: Array,
    last: Array,
    out: Array,
) -> None:
    """Set mean rate, mean specific force and rate of a strapdown IMU."""
    w, x, y, z = quaternion[0], quaternion[1], quaternion[2], quaternion[3]
    axx, axy = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z)
    axz, ayx = 2.0 * (x * z + w * y), 2.0 * (x * y + w * z)
    ayy, ayz = 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    azx, azy = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x)
    azz = 1.0 - 2.0 * (x * x + y * y)
    p, q, r = spin[0], spin[1], spin[2]
    sx = q * place[2] - r * place[1]
    sy = r * place[0] - p * place[2]
    sz = p * place[1] - q * place[0]
    u = velocity[0] + (axx * sx + axy * sy + axz * sz)
    v = velocity[1] + (ayx * sx + ayy * sy + ayz * sz)
    h = velocity[2] + (azx * sx + azy * sy + azz * sz)
    gx, gy, gz = gravity[0], gravity[1], gravity[2]
    mx, my, mz = p, q, r
    fx = -(gx * axx + gy * ayx + gz * azx)
    fy = -(gx * axy + gy * ayy + gz * azy)
    fz = -(gx * axz + gy * ayz + gz * azz)
    passed = clock[0] - last[0]
    if last[0] >= 0.0 and passed > 0.0:
        a, b, c, d = last[1], last[2], last[3], last[4]
        cosine = a * w + b * x + c * y + d * z
        tx = a * x - b * w - c * z + d * y
        ty = a * y + b * z - c * w - d * x
        tz = a * z - b * y + c * x - d * w
        side = -1.0 if cosine < 0.0 else 1.0
        sine = sqrt(tx * tx + ty * ty + tz * tz)
        half = atan2(sine, side * cosine)
        rate = 2.0 * side * (half / sine if sine > 0.0 else 1.0) / passed
        mx, my, mz = rate * tx, rate * ty, rate * tz
        u0 = (u - last[14]) / passed - gx
        v0 = (v - last[15]) / passed - gy
        h0 = (h - last[16]) / passed - gz
        fx = 0.5 * (
            u0 * (last[5] + axx) + v0 * (last[8] + ayx) + h0 * (last[11] + azx)
        )
        fy = 0.5 * (
            u0 * (last[6] + axy) + v0 * (last[9] + ayy) + h0 * (last[12] + azy)
        )
        fz = 0.5 * (
            u0 * (last[7] + axz)
            + v0 * (last[10] + ayz)
            + h0 * (last[13] + azz)
        )
    last[0] = clock[0]
    last[1], last[2], last[3], last[4] = w, x, y, z
    last[5], last[6], last[7] = axx, axy, axz
    last[8], last[9], last[10] = ayx, ayy, ayz
    last[11], last[12], last[13] = azx, azy, azz
    last[14], last[15], last[16] = u, v, h
    for i in range(3):
        out[i] = mx * mount[0, i] + my * mount[1, i] + mz * mount[2, i]
        out[3 + i] = fx * mount[0, i] + fy * mount[1, i] + fz * mount[2, i]
        out[6 + i] = p * mount[0, i] + q * mount[1, i] + r * mount[2, i]


class StrapdownImu:
    """Gyro and accelerometer that integrate between readings.

    One sample per control tick would alias landing impacts, which causes an
    error of half a degree in the estimated tilt.
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
        self._data = data
        self._clock, self._out = np.zeros(1), np.zeros(9)
        self._last = np.zeros(17)  # time, quaternion, axes, velocity
        self._last[0] = -1.0
        mount = np.zeros(9)
        mujoco.mju_quat2Mat(mount, model.site_quat[site])
        self._integrate = bound(
            strapdown,
            data.qpos[at + 3 : at + 7],  # views
            data.qvel[dof : dof + 3],
            data.qvel[dof + 3 : dof + 6],
            model.site_pos[site].copy(),
            mount.reshape(3, 3),
            model.opt.gravity.copy(),
            *(self._clock, self._last, self._out),
        )

    def read(self) -> tuple[Array, Array, Array]:
        """Return mean rate and specific force since the last call, and rate.

        Returns:
            Mean angular velocity, in [rad/s], and mean specific force, in
            [m/s^2], since the last call, and the present angular velocity, in
            the frame of the IMU. Shape (3,) each.
        """
        self._clock[0] = self._data.time
        self._integrate()
        found = self._out.copy()
        return found[:3], found[3:6], found[6:]


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
        """Draw the constant errors of one robot.

        Args:
            body: Magnitudes of the errors.
            generator: Random generator of the errors.
            force_unit: Weight of the robot relative to NAO's.
        """
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
        """Return joint velocities as encoders give them, in [rad/s].

        They are the change of the quantised angles since the last reading.

        Args:
            exact: True velocities, at the first reading. Shape (joints,).
            angles: Quantised angles, in [rad]. Shape (joints,).
            now: Time, in [s].
        """
        last, self._last = self._last, (now, angles)
        if self._body.encoder_step == 0.0 or last is None or now <= last[0]:
            return exact
        changed: Array = (angles - last[1]) / (now - last[0])
        return changed

    def readings(
        self, gyro: Array, force: Array, latest: Array, foot_forces: Array
    ) -> tuple[Array, Array, Array, Array]:
        """Return readings of IMU and feet with their errors.

        Args:
            gyro: True angular velocity, in [rad/s]. Shape (3,).
            force: True specific force, in [m/s^2]. Shape (3,).
            latest: True angular velocity at this instant. Shape (3,).
            foot_forces: True normal forces, in [N]. Shape (8,).

        Returns:
            Noisy and delayed angular velocity, specific force and latest
            angular velocity, and noisy normal forces, at least zero.
        """
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
