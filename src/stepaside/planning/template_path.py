"""Where a body is on the path of its template.

The place of a robot is midway between its feet: that is where the unicycle
of (1) and (3) stands. While it walks the place moves on with the CoM, and
the CoM is ahead of it by as much as the ZMP is ahead of the ankles.
"""

import numpy as np

from ..core.poses import Array, Pose
from .footsteps import Foot
from .gait_settings import GaitSettings
from .schedule import Schedule

STILL = 1e-6  # samples nearer than this are one, in [m]
SHORT = 0.18  # way of a step on the spot, at most, over the feet's distance


def passed_beside(foot: Pose, side: Foot, foot_spacing: float) -> Pose:
    """Pose with which the unicycle passes a foot that stands.

    Args:
        foot: The foot, in any frame.
        side: Which it is.
        foot_spacing: Coronal distance between feet, in [m].
    """
    return foot.compose(Pose(0.0, -0.5 * foot_spacing * side.value, 0.0))


def path_samples(
    placements: Array, first_foot: Foot, foot_spacing: float
) -> Array:
    """Samples of the path beside which feet stand.

    Each is half a spacing beside its foot, and has its heading.

    Args:
        placements: Feet in turn, the first is ``first_foot``'s: rows
            (x [m], y [m], theta [rad]). Shape (n, 3).
        first_foot: Side of the first.
        foot_spacing: Coronal distance between feet, in [m].

    Returns:
        Poses of the unicycle in the same frame. Shape (n, 3).
    """
    samples: Array = np.array(placements, dtype=np.float64)
    half = np.full(len(samples), 0.5 * foot_spacing * first_foot.value)
    half[1::2] *= -1.0
    theta = samples[:, 2]
    samples[:, 0] += half * np.sin(theta)
    samples[:, 1] -= half * np.cos(theta)
    return samples


def poses_on_path(
    samples: Array, com: Array, clock: Array, gait: GaitSettings
) -> Array:
    """Poses of the unicycle where the CoM has come to.

    A sample belongs to a foot, and the body passes it in the middle of the
    support by that foot. In between, way and heading are shared out by how
    far the CoM, less its lead, has come from one sample to the next. Sway
    is as large as a short way, and no way at all: half a step before and
    after what the clock says is the most that is believed, and on the spot
    the clock alone counts.

    Args:
        samples: Of the path, in the order of the steps. Shape (n, 3).
        com: CoM in the same frame, in [m]. Shape (m, 2).
        clock: Shares of each way by time, from the middle of one support
            to that of the next; beyond 0 to 1 outside of it. NaN where the
            clock says nothing. Shape (m, n - 1).
        gait: Lead of the CoM over the place, and how far apart feet are.

    Returns:
        Rows (x [m], y [m], theta [rad]). Shape (m, 3).
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


def clock_of(schedule: Schedule, times: Array) -> Array:
    """Shares of the ways between the feet of a plan by time.

    Of the first way nothing is said where the robot stands before: its
    CoM may be anywhere on it.

    Args:
        schedule: Of the plan.
        times: Since it began, in [s]. Shape (m,).

    Returns:
        As :func:`poses_on_path` takes them. Shape (m, footsteps + 1).
    """
    gait = schedule.settings
    begun = schedule.starts[1] if schedule.standing else 0.0
    second = begun + 0.5 * gait.single_support
    steps = np.arange(schedule.count + 1) - 1.0
    clock: Array = (times[:, None] - second) / gait.step_duration - steps
    if schedule.standing:
        clock[:, 0] = np.nan
    return clock
