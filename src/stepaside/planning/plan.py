"""Planned maneuver as a value (paper, Sec. III)."""

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.convex import convex_hull, half_planes
from ..core.errors import PlanError, shown
from ..core.poses import Array, Pose
from .com import least_values
from .gait_settings import GaitSettings, SoleRectangle
from .path import Direction, Foot, Footstep
from .schedule import Sampler, Schedule


class SupportPhase(NamedTuple):
    """Interval over which the same feet are on the floor."""

    start: float  # start time since the plan began [s]
    end: float  # end time [s]; infinite for the last phase
    rows: tuple[int, ...]  # of the placements whose feet are on the floor
    # of the hull, counter-clockwise, in the plan frame [m]. Shape (n, 2)
    corners: Array
    normals: Array  # outward unit normals of its edges. Shape (n, 2)
    # A ZMP p is in the polygon if normals p <= offsets [m]. Shape (n,)
    offsets: Array

    @property
    def single(self) -> bool:
        """Whether one foot is on the floor."""
        return len(self.rows) == 1


def sole_corners(pose: Array, foot: Foot, sole: SoleRectangle) -> Array:
    """Return the corners of a sole in the frame of its pose. Shape (4, 2)."""
    left = np.array(
        [
            [sole.front, sole.outer],
            [sole.back, sole.outer],
            [sole.back, -sole.inner],
            [sole.front, -sole.inner],
        ]
    )
    left[:, 1] *= foot.value
    return Pose(*pose.tolist()).transform_points(left)


MAX_TIME = 86400.0  # of a sample, in [s]


class PlanSamples(NamedTuple):
    """Samples of a plan at given times, in the plan frame."""

    times: Array  # since the plan began [s]. Shape (m,)
    zmp: Array  # [m]. Shape (m, 2)
    dcm: Array  # [m]. Shape (m, 2)
    com: Array  # [m]. Shape (m, 2)
    com_velocity: Array  # [m/s]. Shape (m, 2)
    left_foot: Array  # rows (x [m], y [m], theta [rad]). Shape (m, 3)
    left_height: Array  # [m]. Shape (m,)
    right_foot: Array
    right_height: Array
    pivot: Array  # ZMP less the reaction of the swing leg [m]. Shape (m, 2)


@dataclass(frozen=True, slots=True)
class ManeuverPlan:
    """Planned maneuver: an immutable value.

    The plan frame is the frame of the support foot of the first step.
    """

    schedule: Schedule  # timing, with its constant maps
    bearing: float  # desired heading [rad]
    direction: Direction
    first_foot: Foot  # that lands first
    # rows (x [m], y [m], theta [rad]): the first swing foot and the support
    # foot at the start, then the footsteps. (count + 2, 3)
    placements: Array
    # anchors, ZMP at the start, correction, CoM at the start [m]; see
    # :class:`Schedule`. (count + 4, 2), one more with a swing reaction
    inputs: Array

    @property
    def gait(self) -> GaitSettings:
        """Gait of the plan."""
        return self.schedule.settings

    @property
    def landing(self) -> Pose:
        """Pose of the first footstep in the plan frame."""
        return Pose(*self.placements[2].tolist())

    @property
    def correction(self) -> Array:
        """Amplitude of the initial ZMP correction, in [m]. Shape (2,)."""
        shift: Array = self.inputs[-2]
        return shift

    @property
    def start_velocity(self) -> Array:
        """CoM velocity at the start, in [m/s]. Shape (2,)."""
        dcm = self.schedule.dcm_start_map @ self.inputs
        velocity: Array = self.schedule.settings.eta * (dcm - self.inputs[-1])
        return velocity

    @property
    def footsteps(self) -> tuple[Footstep, ...]:
        """Footsteps in landing order."""
        foot, steps = self.first_foot, []
        for x, y, theta in self.placements[2:].tolist():
            steps.append(Footstep(foot, x, y, theta))
            foot = foot.other
        return tuple(steps)

    @property
    def zmp_coefficients(self) -> Array:
        """ZMP of each phase by power of local time. Shape (4, phases, 2)."""
        coefficients: Array = self.schedule.zmp_map.coefficients @ self.inputs
        return coefficients

    def support(self, duration: float = inf) -> tuple[SupportPhase, ...]:
        """Return the support phases that begin before a time, without gaps.

        Between two of them both apply: the foot that lands or lifts off is on
        the floor, but the ZMP is already under the foot of single support.
        """
        schedule, placements = self.schedule, self.placements
        sides = (self.first_foot, self.first_foot.other)
        starts = schedule.starts.tolist()
        bearing: list[tuple[int, ...]] = [(0, 1)] * schedule.standing
        for row in range(1, schedule.count + 1):  # of the foot that stands
            bearing += [(row,), (row, row + 1)]
        phases = []
        for i, rows in enumerate(bearing):
            if starts[i] >= duration - 1e-9:
                break
            soles = [
                sole_corners(placements[r], sides[r % 2], self.gait.sole)
                for r in rows
            ]
            corners = convex_hull(np.concatenate(soles))
            end = inf if i == len(bearing) - 1 else starts[i + 1]
            phases.append(
                SupportPhase(
                    starts[i], end, rows, corners, *half_planes(corners)
                )
            )
        return tuple(phases)

    def margin(self, duration: float = inf) -> float:
        """Return the least distance of the ZMP from the polygon's edge, [m].

        Until a duration, in [s]; negative if the ZMP leaves the polygon. The
        distance from each edge is a polynomial in each phase, so its minimum
        is exact.
        """
        coefficients = self.zmp_coefficients
        until = min(duration, self.schedule.duration)
        least = inf
        for i, phase in enumerate(self.support(duration)):
            room = -coefficients[:, i] @ phase.normals.T
            room[0] += phase.offsets
            lasts = min(phase.end, until) - phase.start
            least = min(least, float(least_values(room, lasts).min()))
        return least

    def sample(self, times: ArrayLike | Sampler) -> PlanSamples:
        """Evaluate the plan at times since it began, in [s]. Shape (m,).

        A sampler of its schedule is faster than times.

        Raises:
            PlanError: If the times are not numbers from 0 to a day.
        """
        sampler = (
            times
            if isinstance(times, Sampler)
            else self.schedule.sampler(_checked(times))
        )
        m = sampler.times.size
        pendulum = (sampler.pendulum @ self.inputs).reshape(-1, m, 2)
        feet = (sampler.feet @ self.placements).reshape(2, m, 3)
        zmp, dcm, com = pendulum[:3]
        pivot = pendulum[3] if len(pendulum) > 3 else zmp
        velocity = dcm - com
        velocity *= self.schedule.settings.eta
        support = (feet[0], sampler.support_height)
        swing = (feet[1], sampler.swing_height)
        left, right = (
            (swing, support)
            if self.first_foot is Foot.LEFT
            else (support, swing)
        )
        return PlanSamples(
            sampler.times, zmp, dcm, com, velocity, *left, *right, pivot
        )


def _checked(times: ArrayLike) -> Array:
    try:
        row = np.asarray(times)
    except ValueError:  # rows of several lengths
        row = np.zeros(())
    numbers = row.ndim == 1 and row.size > 0 and row.dtype.kind in "iuf"
    if not numbers or not np.all((row >= -1e-6) & (row <= MAX_TIME)):
        raise PlanError(
            f"times must be a row of numbers in [0, {MAX_TIME:g}] [s], got "
            f"{shown(times)}"
        )
    return row.astype(np.float64)
