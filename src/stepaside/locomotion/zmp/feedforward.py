"""Feedforward of servo deflection under the planned load."""

import numpy as np

from ...core.compilation import bound, compiled
from ...core.poses import Array
from ...robots.joint_loads import LegLoads
from ...robots.leg_kinematics import BodyReference, LegKinematics

BOUND = 0.03  # of the feedforward, in [rad]: a lost leg reference jumps


@compiled
def offset_rows(
    soon: Array, offsets: Array, gain: Array, memory: Array
) -> None:
    """Set the offsets of all ticks but the first from it."""
    for i in range(soon.shape[0]):
        for j in range(soon.shape[1]):
            held = memory[j] * offsets[i, j]
            offsets[i + 1, j] = gain[j] * soon[i, j] + held


class LoadFeedforward:
    r"""Joint offsets that compensate the deflection of servos under load.

    A servo of stiffness k under a torque :math:`\tau` deflects by
    :math:`\tau / k`: in a stance leg of the NAO by up to a degree at the hip,
    so that the swing foot touches the floor early and slides. Servos that
    feed the rate of their targets forward also add :math:`d / k` times the
    rate of the offset, with damping d. So the offset :math:`\delta` solves
    :math:`\delta + (d / k)\, \dot\delta = \tau / k`. The torque is
    extrapolated one tick ahead: a target acts until the next tick, and the
    accelerations are a tick old.

    Attributes:
        loads: Torques of the leg joints.
        compliance: Deflection of each servo by torque, in [rad/(N m)]. Shape
            (joints,).
        gain: Weight of the deflection in the offset. Shape (joints,).
        memory: Weight of the last offset. Shape (joints,).
    """

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Prepare the feedforward of a robot; see :class:`LegLoads`."""
        self.loads = LegLoads(kinematics, zmp_forward=zmp_forward, tick=tick)
        servos = np.array(kinematics.legs.tree.servos, dtype=np.float64)
        stiffness, damping = servos.reshape(-1, 2).T
        stiff = stiffness > 0.0
        self.compliance = np.where(
            stiff, 1.0 / np.where(stiff, stiffness, 1.0), 0
        )
        lead = damping * self.compliance / tick
        self.gain, self.memory = 1.0 / (1.0 + lead), lead / (1.0 + lead)
        # Before the present tick, then of the last rows.
        self._offsets = np.zeros((1, stiffness.size))
        self._deflections: Array | None = None
        one = self._offsets
        bound(offset_rows, one, one, self.gain, self.memory)  # compiles

    def added(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> Array:
        """Return the offsets of one tick, in [rad]. Shape (joints,)."""
        torques = self.loads.torques(reference, zmp)
        offsets: Array = self._filtered(torques[None])[0]
        return offsets

    def offset_rows(
        self, states: Array, references: Array, zmp: Array
    ) -> Array:
        """Return the offsets of consecutive ticks, as :meth:`added` does.

        Args:
            states: States of the legs; see :class:`.LegStates`.
            references: References of the ticks, rows of
                :meth:`.BodyReference.row`. Shape (ticks, 15).
            zmp: ZMP of the plan in odometry, in [m]. Shape (ticks, 2).

        Returns:
            Offsets, in [rad]. Shape (ticks, joints).
        """
        return self._filtered(self.loads.torque_rows(states, references, zmp))

    def rewind(self, ticks: int) -> None:
        """Return to the state after the first ``ticks`` of the last rows."""
        assert self._deflections is not None
        self.loads.rewind(ticks)
        self._offsets = self._offsets[: ticks + 1]
        self._deflections = self._deflections[:ticks]

    def _filtered(self, torques: Array) -> Array:
        """Return the offsets for torques, in [N m]. Shapes (n, joints)."""
        deflections = self.compliance * torques
        last = self._deflections
        before = np.empty_like(deflections)
        before[0] = deflections[0] if last is None else last[-1]
        before[1:] = deflections[:-1]
        soon = 2.0 * deflections - before
        soon.clip(-BOUND, BOUND, out=soon)
        offsets = np.empty((len(soon) + 1, soon.shape[1]))
        offsets[0] = self._offsets[-1]
        offset_rows(soon, offsets, self.gain, self.memory)
        self._offsets, self._deflections = offsets, deflections
        return offsets[1:]
