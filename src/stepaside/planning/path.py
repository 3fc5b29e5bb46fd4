"""Path of the template unicycle, and footsteps along it (Sec. III-B, C)."""

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
        """Return poses (x [m], y [m], theta [rad]) at times. Shape (n, 3)."""
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


class Foot(Enum):
    """Side of the robot; the value is the sign of its coronal offset."""

    LEFT = 1
    RIGHT = -1

    @property
    def other(self) -> "Foot":
        """The foot on the opposite side."""
        return Foot.RIGHT if self is Foot.LEFT else Foot.LEFT


@dataclass(frozen=True, slots=True)
class Footstep:
    """Placement of one foot frame in the plan frame."""

    foot: Foot
    x: float
    y: float
    theta: float


def place_footsteps(
    trajectory: UnicycleTrajectory,
    *,
    count: int,
    stride: float,
    foot_spacing: float,
    first_foot: Foot,
) -> Array:
    r"""Place alternate feet beside a trajectory, at a constant stride.

    The trajectory starts half a spacing beside the support foot, whose frame
    is that of the plan; sample :math:`i = 1, \dots, n` of (9)-(14) is taken at
    :math:`t_i = i \Delta / \bar{v}` and moved sideways by half a spacing. Rows
    (x [m], y [m], theta [rad]) in landing order. Shape (n, 3).
    """
    times = np.arange(1, count + 1) * (stride / trajectory.speed)
    steps = trajectory.poses(times)
    left = np.full(count, 0.5 * foot_spacing * first_foot.value)
    steps[:, 1] += left
    left[1::2] *= -1.0  # signed offset of each foot, in [m]
    steps[:, :2] += rotate(0.0, left, steps[:, 2]).T
    return steps
