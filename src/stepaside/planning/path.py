"""Cartesian trajectory of the template unicycle (paper, Sec. III-B)."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from ..core.poses import Array, arc, rotate
from ..theory import laws


class Direction(Enum):
    """Sign of the driving velocity in eq. (7)."""

    FORWARD = 1  # pursuer
    BACKWARD = -1  # evader


@dataclass(frozen=True, slots=True)
class UnicycleTrajectory:
    r"""Arc of circle, then straight line, from the origin of its frame.

    Eqs. (9)-(14) with :math:`\omega` frozen at :math:`k \theta^*` until
    :math:`t_s = 1 / k`, less the factor sign(theta*) that the text prints
    in (10) and (11): integrating (8) yields none, and only without it does
    the arc join the line at :math:`t_s`.
    """

    bearing: float  # desired heading :math:`\theta^*` in the frame [rad]
    speed: float  # magnitude :math:`\bar{v}` of the driving velocity [m/s]
    gain: float  # steering gain :math:`k` [1/s]
    direction: Direction  # whether the robot walks forward or backward
    saturated: bool = False  # (6) until theta* is reached, rather than (8)

    def poses(self, times: ArrayLike) -> Array:
        r"""Evaluate the trajectory.

        ``times``: Times since planning, in [s]. Shape (n,). Poses (x [m], y
        [m], theta [rad]), columns. Shape (n, 3).
        """
        t = np.asarray(times, dtype=np.float64)
        rate = laws.proportional_rate(self.bearing, self.gain)
        lasts = 1.0 / self.gain  # time on the arc, in [s]
        if self.saturated:
            rate = laws.saturated_rate(self.bearing, self.gain)
            lasts *= abs(self.bearing)
        turning = np.minimum(t, lasts)
        velocity = self.direction.value * self.speed
        along = velocity * (t - turning)  # on the line, in [m]
        poses = arc(velocity * turning, 0.0, turning * rate)
        poses[:, :2] += rotate(along, 0.0, poses[:, 2]).T
        return poses
