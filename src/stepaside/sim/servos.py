"""Position servos of a body."""

from collections import deque
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.compilation import bound, compiled
from ..core.poses import Array
from .body_settings import IDEAL, BodySettings

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
        body: BodySettings = IDEAL,
        backlash: Array | float = 0.0,
        *,
        feedforward: bool = True,
    ) -> None:
        """Drive consecutive actuators with limits [rad/s] and a cycle [s]."""
        count = actuators.size
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
        # Before the backlash, which is of the present angle: MuJoCo would
        # delay both, and with 1 degree a joint is up to 2.6 mrad elsewhere.
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
        self.ideal = body == IDEAL or body.has_ideal_servos
        if not self.ideal:
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
