"""Errors of sensors and masses of a body, like those of real ones."""

from collections import deque
from collections.abc import Iterator

import mujoco
import numpy as np

from ..core.poses import Array
from .body_settings import BodySettings


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
        self._data, self._gravity = data, model.opt.gravity.copy()
        self._quaternion = data.qpos[at + 3 : at + 7]  # views
        self._velocity = data.qvel[dof : dof + 3]
        self._spin = data.qvel[dof + 3 : dof + 6]
        x, y, z = model.site_pos[site].tolist()
        self._lever = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        mount = np.zeros(9)
        mujoco.mju_quat2Mat(mount, model.site_quat[site])
        self._mount = mount.reshape(3, 3)
        self._last: tuple[float, Array, Array, Array] | None = None

    def read(self) -> tuple[Array, Array, Array]:
        """Return mean rate and specific force since the last call, and rate.

        They are in the frame of the IMU, in [rad/s] and [m/s^2].
        """
        now, quaternion = self._data.time, self._quaternion.copy()
        frame = np.empty(9)
        mujoco.mju_quat2Mat(frame, quaternion)
        axes, rate = frame.reshape(3, 3), self._spin.copy()
        velocity = self._velocity + axes @ (self._lever @ rate)
        mean, force = rate, -self._gravity @ axes
        if self._last is not None and now > self._last[0]:
            then, before, axes_before, velocity_before = self._last
            turn, passed = np.empty(3), now - then
            mujoco.mju_subQuat(turn, quaternion, before)
            mean = turn / passed
            change = (velocity - velocity_before) / passed - self._gravity
            force = 0.5 * (change @ (axes_before + axes))
        self._last = now, quaternion, axes, velocity
        mount = self._mount
        return mean @ mount, force @ mount, rate @ mount


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
