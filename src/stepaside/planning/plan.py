"""A maneuver that was planned, as a value (paper, Sec. III)."""

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.brief_repr import brief_repr
from ..core.errors import PlanError, shown
from ..core.poses import Array
from .footsteps import Foot, Footstep
from .gait_settings import GaitSettings
from .path import Direction
from .schedule import Sampler, Schedule
from .support_polygon import SupportPhase, support_phases
from .zmp import least_values

LONGEST = 86400.0  # time of a sample, in [s]: nobody walks on for a day


class PlanSamples(NamedTuple):
    """A plan at given times, in the plan frame.

    Attributes:
        times: Times since the plan began, in [s]. Shape (m,).
        zmp: Zero moment point, in [m]. Shape (m, 2).
        dcm: Divergent component of motion, in [m]. Shape (m, 2).
        com: Center of mass, in [m]. Shape (m, 2).
        com_velocity: Its velocity, in [m/s]. Shape (m, 2).
        left_foot: Left foot (x [m], y [m], theta [rad]). Shape (m, 3).
        left_height: Height of the left foot, in [m]. Shape (m,).
        right_foot: Right foot, likewise. Shape (m, 3).
        right_height: Height of the right foot, in [m]. Shape (m,).
        pivot: Point that the CoM falls away from, in [m]; the ZMP, but for
            what the swing leg takes. Shape (m, 2).
    """

    times: Array
    zmp: Array
    dcm: Array
    com: Array
    com_velocity: Array
    left_foot: Array
    left_height: Array
    right_foot: Array
    right_height: Array
    pivot: Array

    def __repr__(self) -> str:
        """Fields in one short line."""
        return brief_repr(self)


@dataclass(frozen=True, slots=True)
class ManeuverPlan:
    """One maneuver: a value that is replaced, never edited.

    The plan frame is the frame of the support foot of the first step.

    Attributes:
        schedule: Timing, with its constant maps.
        bearing: Desired heading that was planned for, in [rad].
        direction: Whether the robot walks forward or backward.
        first_foot: Foot that lands first.
        placements: Rows (x [m], y [m], theta [rad]): the first swing foot
            and the support foot at the start, then the footsteps.
            Shape (count + 2, 3).
        inputs: Anchors, ZMP at the start, correction, CoM at the start, in
            [m]; see :class:`~stepaside.planning.schedule.Schedule`.
            Shape (count + 4, 2), one more if the swing leg is felt.
    """

    __repr__ = brief_repr

    schedule: Schedule
    bearing: float
    direction: Direction
    first_foot: Foot
    placements: Array
    inputs: Array

    @property
    def gait(self) -> GaitSettings:
        """Gait at the pace of the plan."""
        return self.schedule.settings

    @property
    def correction(self) -> Array:
        """Greatest ZMP shift that keeps the CoM continuous. Shape (2,)."""
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
        """Feet on the floor over time, as half planes for the ZMP.

        Args:
            duration: Phases that begin later than this are left out, in [s].
        """
        return support_phases(
            self.schedule, self.placements, self.first_foot, duration
        )

    def margin(self, duration: float = inf) -> float:
        """Least distance of the ZMP from the edge of the support polygon.

        The distance from each edge is a polynomial in each phase, so its
        least value is exact, not one of samples.

        Args:
            duration: Part of the plan to look at from its start, in [s];
                all of it by default.

        Returns:
            Margin, in [m], negative if the ZMP leaves the polygon.
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
        """Evaluate the plan.

        Args:
            times: Times since the plan began, in [s], shape (m,); or a
                sampler of this plan's schedule, which is faster.

        Raises:
            PlanError: If they are no row of numbers from 0 to a day.
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
    """Times, if they are some that a plan has a value for."""
    try:
        row = np.asarray(times)
    except ValueError:  # rows of several lengths
        row = np.zeros(())
    numbers = row.ndim == 1 and row.size > 0 and row.dtype.kind in "iuf"
    if not numbers or not np.all((row >= -1e-6) & (row <= LONGEST)):
        raise PlanError(
            f"times must be a row of numbers in [0, {LONGEST:g}] [s], got "
            f"{shown(times)}"
        )
    return row.astype(np.float64)
