"""What the servos give way under load, added to their targets beforehand."""

import numpy as np

from ...core.poses import Array
from ...robots.joint_loads import LegLoads
from ...robots.leg_kinematics import BodyReference, LegKinematics

BOUND = 0.03  # what is added at most: legs that lose a reference jump, [rad]


class LoadFeedforward:
    r"""Joint targets that are off by as much as the load bends the servos.

    A servo of stiffness k that bears a torque :math:`\tau` stands
    :math:`\tau / k` off its target: a standing leg of NAO's by up to a
    degree in the hip, which lets the other foot touch the floor early and
    slide. Servos that feed the speed of their targets forward would do so
    with what is added, too: by :math:`d / k` times its rate, d being their
    damping. So added is a :math:`\delta` with
    :math:`\delta + (d / k)\, \dot\delta = \tau / k`. The torque is that of
    a tick ahead, by its last change: what is sent acts until the next tick,
    and the accelerations in it are a tick old.
    """

    def __init__(
        self, kinematics: LegKinematics, *, zmp_forward: float, tick: float
    ) -> None:
        """Know a robot; see :class:`LegLoads`."""
        self._loads = LegLoads(kinematics, zmp_forward=zmp_forward, tick=tick)
        servos = np.array(kinematics.legs.tree.servos, dtype=np.float64)
        stiffness, damping = servos.reshape(-1, 2).T
        stiff = stiffness > 0.0
        self._give = np.where(stiff, 1.0 / np.where(stiff, stiffness, 1.0), 0)
        lead = damping * self._give / tick
        self._gain, self._kept = 1.0 / (1.0 + lead), lead / (1.0 + lead)
        self._added = np.zeros(stiffness.size)
        self._bent: Array | None = None

    def added(
        self, reference: BodyReference, zmp: tuple[float, float]
    ) -> Array:
        """What to add at one tick, in [rad]. Shape (joints,).

        Args:
            reference: What the present posture was to reach.
            zmp: ZMP of the plan, in [m].
        """
        bent = self._give * self._loads.torques(reference, zmp)
        last = bent if self._bent is None else self._bent
        self._bent = bent
        soon = 2.0 * bent - last
        soon.clip(-BOUND, BOUND, out=soon)
        self._added = self._gain * soon + self._kept * self._added
        return self._added
