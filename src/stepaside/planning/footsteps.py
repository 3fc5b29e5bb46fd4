"""Footsteps around a Cartesian trajectory (paper, Sec. III-C)."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..core.poses import Array, rotate
from .path import UnicycleTrajectory


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

    The plan frame is the frame of the support foot, the one that does not
    land first. The trajectory starts half a spacing beside it, midway to
    the other foot when abreast; sample :math:`i = 1, \dots, n` of
    (9)-(14) is taken at :math:`t_i = i \Delta / \bar{v}` and moved sideways
    by half a spacing.

    ``foot_spacing``: Coronal distance between the foot frames, in [m]. Rows (x
    [m], y [m], theta [rad]) in the plan frame, in landing order; odd rows are
    of the other foot. Shape (n, 3).
    """
    times = np.arange(1, count + 1) * (stride / trajectory.speed)
    steps = trajectory.poses(times)
    left = np.full(count, 0.5 * foot_spacing * first_foot.value)
    steps[:, 1] += left
    left[1::2] *= -1.0  # signed offset of each foot, in [m]
    steps[:, :2] += rotate(0.0, left, steps[:, 2]).T
    return steps
