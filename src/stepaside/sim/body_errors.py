"""Servos and sensors of a body, with the errors of real ones."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.compilation import bound, compiled
from ..core.poses import Array
from .body_settings import BodySettings

JointGains = Mapping[str, tuple[float, float]]
"""Stiffness [N m/rad] and damping [N m s/rad] by joint."""


def set_joint_gains(
    model: mujoco.MjModel,
    actuators: np.ndarray,
    names: Sequence[str],
    gains: JointGains,
) -> None:
    """Set gains of the torque k_p (q* - q) - k_d dq/dt, where given."""
    for actuator, name in zip(actuators.tolist(), names, strict=True):
        if name in gains:
            stiffness, damping = gains[name]
            model.actuator_gainprm[actuator, 0] = stiffness
            model.actuator_biasprm[actuator, 1:3] = -stiffness, -damping


@compiled
def take_targets(
    wanted: Array,
    target: Array,
    change: Array,
    reach: Array,
    lead: Array,
    sent: Array,
) -> None:
    """Begin a cycle: send targets, limited in speed, with their velocity."""
    for j in range(wanted.shape[0]):
        target[j] += change[j]
        change[j] = max(min(wanted[j] - target[j], reach[j]), -reach[j])
        sent[j] = target[j] + change[j] + lead[j] * change[j]


@compiled
def servo_step(
    qpos: Array,
    qvel: Array,
    angles: NDArray[np.int64],
    rates: NDArray[np.int64],
    change: Array,
    target: Array,
    lead: Array,
    half: Array,
    stall: Array,
    slope: Array,
    clock: Array,
    sent: Array,
    limits: Array,
) -> None:
    """Set control and torque limits of :class:`Servos`."""
    clock[0] = min(clock[0] + clock[1], clock[2])
    share = clock[0] / clock[2]
    for j in range(target.shape[0]):
        angle = qpos[angles[j]]
        error = target[j] + change[j] * share - angle
        error -= min(max(error, -half[j]), half[j])
        sent[j] = error + angle + lead[j] * change[j]
        loss = slope[j] * qvel[rates[j]]
        limits[j, 1] = min(max(stall[j] - loss, 0.0), stall[j])
        limits[j, 0] = max(min(-stall[j] - loss, 0.0), -stall[j])


class Servos:
    """Position servos, with delay, backlash and torque that falls with speed.

    Targets are limited to the speed limits of the joints, and their velocity
    is fed forward; else each is sent as it is. With errors of a body a target
    takes effect after some cycles, and the servo ramps to it in one cycle.
    Within the backlash the motor turns without the joint.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        actuators: np.ndarray,
        speed_limits: Array,
        cycle: float,
        body: BodySettings | None = None,
        backlash: Array | float = 0.0,
        *,
        feedforward: bool = True,
    ) -> None:
        """Drive consecutive actuators with limits [rad/s] and a cycle [s]."""
        body, count = body or BodySettings(), actuators.size
        model.actuator_gainprm[actuators, 0] *= body.servo_gain
        model.actuator_biasprm[actuators, 1] *= body.servo_gain
        driven = slice(int(actuators[0]), int(actuators[-1]) + 1)
        self._sent: Array = data.ctrl[driven]  # a view
        gains = model.actuator_gainprm[actuators, 0]
        self.lead = -model.actuator_biasprm[actuators, 2] / gains / cycle
        self.reach = speed_limits * cycle
        if not feedforward:
            self.lead = np.zeros(count)
            self.reach = np.full(count, np.inf)
        self._target, self._change = np.zeros(count), np.zeros(count)
        self._wanted = np.zeros(count)
        self._take = bound(
            *(take_targets, self._wanted, self._target, self._change),
            *(self.reach, self.lead, self._sent),
        )
        self._range = model.actuator_forcerange[driven]
        self._full = self._range[:, 1] * (body.efficiency * body.stiffness)
        self._no_load = speed_limits if body.torque_speed else np.inf
        self._stall, self._slope = np.zeros(count), np.zeros(count)
        self._pending: deque[Array] = deque()
        self._delay = body.delay_cycles
        # Time since the targets, period of the physics, control period.
        self._clock = np.array([0.0, model.opt.timestep, cycle])
        joints = model.actuator_trnid[actuators, 0]
        self._step = bound(
            *(servo_step, data.qpos, data.qvel),
            model.jnt_qposadr[joints].astype(np.int64),
            model.jnt_dofadr[joints].astype(np.int64),
            *(self._change, self._target, self.lead),
            *(np.full(count, 0.5 * backlash), self._stall, self._slope),
            *(self._clock, self._sent, self._range),
        )
        if not body.has_ideal_servos:
            self.soften(np.ones(count))

    def soften(self, stiffness: Array) -> None:
        """Limit the torques to fractions of their maximum, 0 to 1."""
        self._stall[:] = self._full * stiffness
        self._slope[:] = self._stall / self._no_load
        self._range[:, 0], self._range[:, 1] = -self._stall, self._stall

    def reset(self, targets: Array) -> None:
        """Set targets, in [rad], without motion towards them."""
        self._target[:] = self._sent[:] = targets
        self._change.fill(0.0)
        self._pending = deque([targets] * self._delay)

    def write(self, targets: Array) -> None:
        """Queue new targets, in [rad]. Shape (joints,)."""
        self._pending.append(targets)
        self._wanted[:] = self._pending.popleft()
        self._take()
        self._clock[0] = 0.0

    def before_step(self, time: float) -> None:
        """Set control and torque limits for one step of a body with errors."""
        self._step()


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
