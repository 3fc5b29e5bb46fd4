"""Position servos of a body."""

from collections import deque
from collections.abc import Iterable, Mapping, Sequence

import mujoco
import numpy as np

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
        others: "Servos | None" = None,
    ) -> None:
        """Drive consecutive actuators with limits [rad/s] and a cycle [s].

        With errors, the step of the last robot is that of all ``others``.
        """
        count = actuators.size
        model.actuator_gainprm[actuators, 0] *= body.servo_gain
        model.actuator_biasprm[actuators, 1] *= body.servo_gain
        driven = slice(int(actuators[0]), int(actuators[-1]) + 1)
        self._sent: Array = data.ctrl[driven]  # a view
        self.ideal = body == IDEAL or body.has_ideal_servos
        rows: Iterable[Array] = np.zeros((7, count))
        if not self.ideal:
            from .body_errors import ServoTable

            self.table: ServoTable = (
                others.table if others else ServoTable.of(model)
            )
            rows = self.table.drive(model, actuators, driven)
            self.before_step = self.table.step(model, data, cycle)
        self._target, self._change, self.lead, half, *more = rows
        self._stall, self._slope, self._clock = more
        gains = model.actuator_gainprm[actuators, 0]
        self.reach = np.full(count, np.inf)
        if feedforward:
            damping = -model.actuator_biasprm[actuators, 2]
            self.lead[:] = damping / gains / cycle
            self.reach = speed_limits * cycle
        half[:] = 0.5 * backlash
        self._wanted = np.zeros(count)
        self._take = bound(
            *(take_targets, self._wanted, self._target, self._change),
            *(self.reach, self.lead, self._sent),
        )
        self._range = model.actuator_forcerange[driven]
        self._full = self._range[:, 1] * (body.efficiency * body.stiffness)
        self._no_load = speed_limits if body.torque_speed else np.inf
        # Before the backlash, which is of the present angle: MuJoCo would
        # delay both, and with 1 degree a joint is up to 2.6 mrad elsewhere.
        self._pending: deque[Array] = deque()
        self._delay = body.delay_cycles
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
        self._clock.fill(0.0)
