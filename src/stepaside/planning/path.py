"""Path of the template unicycle, and footsteps along it (Sec. III-B, C).

The reference point of a robot is midway between its feet, where the unicycle
of (1) and (3) is. While the robot walks, the point advances with the CoM,
which leads it by as much as the ZMP leads the foot frames.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from ..core.poses import Array, Pose, arc, rotate
from ..theory import laws
from .gait_settings import GaitSettings
from .schedule import Schedule


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

    bearing: float  # desired heading theta* in the frame [rad]
    speed: float  # magnitude of the driving velocity [m/s]
    gain: float  # steering gain k [1/s]
    direction: Direction
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
    is that of the plan; its samples at :math:`t_i = i \Delta / \bar{v}` are
    moved sideways by half a spacing. Poses in landing order. Shape (n, 3).
    """
    times = np.arange(1, count + 1) * (stride / trajectory.speed)
    steps = trajectory.poses(times)
    left = np.full(count, 0.5 * foot_spacing * first_foot.value)
    steps[:, 1] += left
    left[1::2] *= -1.0  # signed offset of each foot, in [m]
    steps[:, :2] += rotate(0.0, left, steps[:, 2]).T
    return steps


STILL = 1e-6  # samples closer than this coincide, in [m]
SHORT = 0.18  # largest stride of a step on the spot, in foot spacings


def pose_beside_foot(foot: Pose, side: Foot, foot_spacing: float) -> Pose:
    """Return the pose with which the unicycle passes a stance foot."""
    return foot.compose(Pose(0.0, -0.5 * foot_spacing * side.value, 0.0))


def path_samples(
    placements: Array, first_foot: Foot, foot_spacing: float
) -> Array:
    """Return the path of the unicycle, half a spacing beside each foot.

    Feet alternate, beginning with the first one. Shape (n, 3).
    """
    samples: Array = np.array(placements, dtype=np.float64)
    right = np.full(len(samples), -0.5 * foot_spacing * first_foot.value)
    right[1::2] *= -1.0
    samples[:, :2] += rotate(0.0, right, samples[:, 2]).T
    return samples


def poses_on_path(
    samples: Array, com: Array, clock: Array, gait: GaitSettings
) -> Array:
    """Return the poses of the unicycle for CoM positions (m, 2), in [m].

    The body passes each sample (n, 3) in the middle of the support by its
    foot. In between, position and heading are interpolated by the progress of
    the CoM, less its lead. Since sway can exceed a short stride, the progress
    is limited to half a step before and after that by time, ``clock`` (m, n -
    1), which may be NaN; on the spot it is that by time. Shape (m, 3).
    """
    ways = np.diff(samples, axis=0)
    middle = samples[:-1, 2] + 0.5 * ways[:, 2]
    lead = ways[:, 0] * np.cos(middle) + ways[:, 1] * np.sin(middle)
    offset = com[:, None, :] - samples[None, :-1, :2]
    come = (offset * ways[None, :, :2]).sum(axis=2) - gait.zmp_forward * lead
    length = (ways[:, :2] ** 2).sum(axis=1)
    moves = length > STILL**2
    shares = np.where(moves, come / np.where(moves, length, 1.0), 1.0)
    timed, short = np.isfinite(clock), SHORT * gait.foot_spacing
    shares = np.where(timed & (length < short**2), clock, shares)
    low = np.where(timed, clock - 0.5, 0.0)
    high = np.where(timed, clock + 0.5, 1.0)
    shares = np.clip(np.clip(shares, low, high), 0.0, 1.0)
    poses: Array = samples[0] + shares @ ways
    return poses


def progress_by_time(schedule: Schedule, times: Array) -> Array:
    """Return the progress between the feet of a plan by time.

    The first one is NaN for a start from standing. Shape (m, footsteps + 1).
    """
    gait = schedule.settings
    begun = schedule.starts[1] if schedule.standing else 0.0
    second = begun + 0.5 * gait.single_support
    steps = np.arange(schedule.count + 1) - 1.0
    clock: Array = (times[:, None] - second) / gait.step_duration - steps
    if schedule.standing:
        clock[:, 0] = np.nan
    return clock
