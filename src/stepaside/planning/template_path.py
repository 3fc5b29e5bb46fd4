"""Pose of the template unicycle of a walking body.

The reference point of a robot is midway between its feet, where the unicycle
of (1) and (3) is. While the robot walks, the point advances with the CoM,
which leads it by as much as the ZMP leads the foot frames.
"""

import numpy as np

from ..core.poses import Array, Pose, rotate
from .gait_settings import GaitSettings
from .path import Foot
from .schedule import Schedule

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
