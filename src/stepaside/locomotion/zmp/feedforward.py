"""Feedforward of servo deflection under the planned load."""

import numpy as np

from ...core.poses import Array
from ...robots.joint_loads import LegLoads
from ...robots.leg_kinematics import BodyReference, LegKinematics

BOUND = 0.03  # of the feedforward, in [rad]: a lost leg reference jumps


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
    """

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Prepare the feedforward of a robot; see :class:`LegLoads`."""
        self._loads = LegLoads(kinematics, zmp_forward=zmp_forward, tick=tick)
        servos = np.array(kinematics.legs.tree.servos, dtype=np.float64)
        stiffness, damping = servos.reshape(-1, 2).T
        stiff = stiffness > 0.0
        self._compliance = np.where(
            stiff, 1.0 / np.where(stiff, stiffness, 1.0), 0
        )
        lead = damping * self._compliance / tick
        self._gain, self._memory = 1.0 / (1.0 + lead), lead / (1.0 + lead)
        self._offset = np.zeros(stiffness.size)
        self._deflection: Array | None = None

    def added(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> Array:
        """Return the offsets of one tick, in [rad]. Shape (joints,).

        Args:
            reference: Body reference of the present posture.
            zmp: ZMP of the plan in odometry, in [m].
        """
        deflection = self._compliance * self._loads.torques(reference, zmp)
        last = deflection if self._deflection is None else self._deflection
        self._deflection = deflection
        soon = 2.0 * deflection - last
        soon.clip(-BOUND, BOUND, out=soon)
        self._offset = self._gain * soon + self._memory * self._offset
        return self._offset
