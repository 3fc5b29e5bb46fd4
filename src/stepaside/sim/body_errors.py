"""Errors of sensors, servos and masses of a body, as of real ones."""

from collections import deque
from collections.abc import Callable
from math import atan2, sqrt
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

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
    mount: Array,
    means: Array,
    now: float,
) -> None:
    """Set mean rate, mean specific force and rate; see :class:`StrapdownImu`.

    ``means`` (3, 3) are in the frame of the IMU, whose axes in the torso are
    the columns of ``mount``. ``last`` are time, quaternion, axes and velocity
    of the IMU of the last call, with a negative time before the first.
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
    for i in range(3):
        x_mean, y_mean, z_mean = means[i, 0], means[i, 1], means[i, 2]
        for k in range(3):
            means[i, k] = x_mean * mount[0, k] + y_mean * mount[1, k]
            means[i, k] += z_mean * mount[2, k]
    last[0], last[1], last[2], last[3], last[4] = now, w, x, y, z


class StrapdownImu:
    """Gyro and accelerometer that integrate between readings, as real ones do.

    One sample per tick would alias landing impacts: half a degree of tilt.
    The means follow from the change of orientation and velocity of the torso.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        root: int,
        site: int,
        means: Array | None = None,
    ) -> None:
        """Measure at a site of a body; means (3, 3) are set if given."""
        joint = model.body_jntadr[root]
        at, dof = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
        self._data = data
        self._means = np.zeros((3, 3)) if means is None else means
        mount = np.zeros(9)
        mujoco.mju_quat2Mat(mount, model.site_quat[site])
        last = np.zeros(17)
        last[0] = -1.0
        self._integrate = bound(
            integrate_motion,
            *(data.qpos[at + 3 : at + 7], data.qvel[dof : dof + 3]),
            *(data.qvel[dof + 3 : dof + 6], model.site_pos[site].copy()),
            *(model.opt.gravity.copy(), last, mount.reshape(3, 3)),
            self._means,
            more=(0.0,),
        )

    def read(self) -> Array:
        """Set mean rate and specific force since the last call, and rate.

        They are in the frame of the IMU, in [rad/s] and [m/s^2]. Shape (3, 3).
        """
        self._integrate(self._data.time)
        return self._means


BLOCK = 64  # readings whose noise is drawn together
FORCES, ANGLES = 9, 17  # where these begin in a reading


@compiled
def add_errors(
    exact: Array,
    noise: Array,
    bias: Array,
    gains: Array,
    step: float,
    found: Array,
    row: int,
) -> None:
    """Set a reading with errors; see :class:`SensorErrors`."""
    for i in range(6):
        found[i] = exact[i] + bias[i] + noise[row, i]
    for i in range(3):
        found[6 + i] = exact[6 + i] + found[i] - exact[i]
    for i in range(8):
        force = exact[FORCES + i] * gains[i] + noise[row, 6 + i]
        found[FORCES + i] = max(force, 0.0)
    for i in range(ANGLES, exact.shape[0]):
        found[i] = exact[i]
        if step > 0.0:
            found[i] = np.rint(exact[i] / step) * step


class SensorErrors:
    """Noise, bias, resolution and delay of the sensors of one robot.

    Attributes:
        exact: What is measured: mean rate and specific force since the last
            reading, rate, foot forces, joint angles. Shape (17 + joints,).
    """

    def __init__(
        self,
        body: BodySettings,
        generator: np.random.Generator,
        joints: int,
        *,
        force_unit: float = 1.0,
    ) -> None:
        self._body = body
        self._generator = generator
        # Of gyro, then accelerometer.
        bias = np.repeat((body.gyro_bias, body.accelerometer_bias), 3)
        bias *= generator.uniform(-1, 1, 6)
        self._deviations = np.repeat(
            (
                body.gyro_noise,
                body.accelerometer_noise,
                body.force_noise * force_unit,
            ),
            (3, 3, 8),
        )
        # Noise of coming readings; drawn together as if one by one.
        self._noise, self._row = np.zeros((BLOCK, 14)), BLOCK
        gains = 1.0 + body.force_gain_error * generator.uniform(-1, 1, 8)
        self._last: tuple[float, Array] | None = None
        self._imu: deque[Array] = deque(maxlen=body.imu_delay_cycles + 1)
        self.exact = np.zeros(ANGLES + joints)
        self._add = bound(
            *(add_errors, self.exact, self._noise, bias, gains),
            body.encoder_step,
            more=(self.exact, 0),
        )

    def velocities(self, exact: Array, angles: Array, now: float) -> Array:
        """Return velocities [rad/s] as the change of the quantised angles."""
        last, self._last = self._last, (now, angles)
        if self._body.encoder_step == 0.0 or last is None or now <= last[0]:
            return exact
        changed: Array = (angles - last[1]) / (now - last[0])
        return changed

    def readings(self) -> tuple[Array, Array, Array, Array, Array]:
        """Return angles, rate, specific force, latest rate, foot forces."""
        if self._row == BLOCK:
            drawn = self._generator.standard_normal((BLOCK, 14))
            self._noise[:], self._row = drawn * self._deviations, 0
        found = np.empty(self.exact.size)
        self._add(found, self._row)
        self._row += 1
        self._imu.append(found[:FORCES])
        late = self._imu[0]
        return (
            *(found[ANGLES:], late[:3], late[3:6], late[6:]),
            found[FORCES:ANGLES],
        )


@compiled
def servo_step(
    qpos: Array,
    qvel: Array,
    angles: NDArray[np.int64],
    rates: NDArray[np.int64],
    table: Array,
    sent: Array,
    limits: Array,
    period: float,
    cycle: float,
) -> None:
    """Set control and torque limits of all :class:`.Servos` of a world."""
    for j in range(angles.shape[0]):
        if angles[j] < 0:
            continue
        table[6, j] = min(table[6, j] + period, cycle)
        share = table[6, j] / cycle
        change, lead, half = table[1, j], table[2, j], table[3, j]
        angle, stall = qpos[angles[j]], table[4, j]
        error = table[0, j] + change * share - angle
        error -= min(max(error, -half), half)
        sent[j] = error + angle + lead * change
        loss = table[5, j] * qvel[rates[j]]
        limits[j, 1] = min(max(stall - loss, 0.0), stall)
        limits[j, 0] = max(min(-stall - loss, 0.0), -stall)


class ServoTable(NamedTuple):
    """Servos of all robots in a world, for one step of its physics."""

    # index of each actuator's joint in qpos, -1 if it is not driven, and of
    # its velocity, (actuators,)
    angles: NDArray[np.int64]
    rates: NDArray[np.int64]
    # target, its change in a cycle, lead, half of the backlash, stall torque,
    # its decrease with speed, and time since the target, (7, actuators)
    table: Array

    @classmethod
    def of(cls, model: mujoco.MjModel) -> "ServoTable":
        """Return a table without servos."""
        count = model.nu
        angles, rates = np.full((2, count), -1, dtype=np.int64)
        return cls(angles, rates, np.zeros((7, count)))

    def drive(
        self, model: mujoco.MjModel, actuators: np.ndarray, driven: slice
    ) -> Array:
        """Drive consecutive actuators; return their rows, (7, count)."""
        joints = model.actuator_trnid[actuators, 0]
        self.angles[driven] = model.jnt_qposadr[joints]
        self.rates[driven] = model.jnt_dofadr[joints]
        rows: Array = self.table[:, driven]
        return rows

    def step(
        self, model: mujoco.MjModel, data: mujoco.MjData, cycle: float
    ) -> Callable[[float], None]:
        """Return the function to be called before each step of the physics.

        The cycle is the control period, in [s].
        """
        run = bound(
            *(servo_step, data.qpos, data.qvel, *self),
            *(data.ctrl, model.actuator_forcerange),
            *(model.opt.timestep, cycle),
        )
        return lambda time: run()


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
