"""Maneuver planning: path, footsteps, ZMP and CoM (paper, Sec. III-B to E)."""

from dataclasses import dataclass
from math import cos, inf, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..errors import PlanError, check_finite, check_positive
from ..poses import Array, Pose
from .footsteps import Foot, Footstep, place_footsteps
from .path import Direction, UnicycleTrajectory
from .schedule import Sampler, Schedule
from .settings import GaitSettings
from .support import convex_hull, margin_inside, sole_corners
from .zmp import evaluate


class CenterState(NamedTuple):
    """Present state of the CoM in the frame of the next support foot.

    Attributes:
        position: Sagittal and coronal coordinate, in [m].
        velocity: Their rates, in [m/s].
    """

    position: tuple[float, float]
    velocity: tuple[float, float]


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
            Shape (count + 4, 2).
    """

    schedule: Schedule
    bearing: float
    direction: Direction
    first_foot: Foot
    placements: Array
    inputs: Array

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

    def margin(self, duration: float | None = None) -> float:
        """Least distance of the ZMP from the edge of the support polygon.

        Args:
            duration: Part of the plan to look at from its start, in [s];
                all of it by default.

        Returns:
            Margin, in [m], negative if the ZMP leaves the polygon.
        """
        schedule, sole = self.schedule, self.schedule.settings.sole
        coefficients = self.zmp_coefficients
        first = 1 if schedule.standing else 0
        least = inf
        for phase, (start, lasts) in enumerate(
            zip(schedule.starts.tolist(), schedule.durations, strict=False)
        ):
            if duration is not None and start >= duration - 1e-9:
                break
            zmp = evaluate(
                np.repeat(coefficients[:, phase, None], 21, axis=1),
                np.linspace(0.0, lasts, 21),
            )
            step, double = divmod(phase - first, 2)
            rows = (step + 1, step + 2) if double else (step + 1,)
            corners = [
                sole_corners(self.placements[row], self._foot(row), sole)
                for row in (rows if step >= 0 else (0, 1))
            ]
            polygon = convex_hull(np.concatenate(corners))
            least = min(least, float(margin_inside(zmp, polygon).min()))
        return least

    def _foot(self, row: int) -> Foot:
        """Side of a row of the placements."""
        return self.first_foot if row % 2 == 0 else self.first_foot.other

    def sample(self, times: ArrayLike | Sampler) -> PlanSamples:
        """Evaluate the plan.

        Args:
            times: Times since the plan began, in [s], shape (m,); or a
                sampler of this plan's schedule, which is faster.
        """
        sampler = (
            times
            if isinstance(times, Sampler)
            else self.schedule.sampler(times)
        )
        m = sampler.times.size
        pendulum = (sampler.pendulum @ self.inputs).reshape(3, m, 2)
        feet = (sampler.feet @ self.placements).reshape(2, m, 3)
        zmp, dcm, com = pendulum
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
            sampler.times, zmp, dcm, com, velocity, *left, *right
        )


class ManeuverPlanner:
    """Plans maneuvers for one gait, pursuer's and evader's alike.

    Attributes:
        settings: Gait.
    """

    def __init__(self, settings: GaitSettings) -> None:
        """Prepare a planner; the maps of each schedule are made once."""
        self.settings = settings
        self._schedules: dict[tuple[int, bool], Schedule] = {}

    def schedule(self, count: int, *, standing: bool) -> Schedule:
        """Timing of ``count`` footsteps, made at first use."""
        key = (count, standing)
        if key not in self._schedules:
            check_positive(count, "count", "steps")
            self._schedules[key] = Schedule(
                self.settings, count, standing=standing
            )
        return self._schedules[key]

    def plan(
        self,
        bearing: float,
        direction: Direction,
        *,
        first_foot: Foot,
        state: CenterState | None = None,
        swing_start: Pose | None = None,
        standing: bool = False,
        saturated: bool = False,
        count: int | None = None,
    ) -> ManeuverPlan:
        r"""Plan one maneuver (Fig. 4, red box).

        Args:
            bearing: Desired heading :math:`\theta^*` in the frame of the
                next support foot, in [rad].
            direction: Forward for the pursuer, backward for the evader.
            first_foot: Foot that lands first; the other one supports.
            state: Present CoM; may be left out when standing, which means
                at rest midway between the feet.
            swing_start: Pose of the first swing foot in the frame of the
                support foot; abreast of it by default.
            standing: Whether the robot starts from standing: then the plan
                begins with a double support, else with a single support.
            saturated: Whether the template turns by (6) instead of (8).
            count: Footsteps; by default the horizon of the settings.

        Returns:
            The plan; CoM position and velocity at its start are the given
            ones.

        Raises:
            PlanError: If the bearing or the state is not finite, or the state
                is missing.
        """
        gait = self.settings
        schedule = self.schedule(
            gait.horizon if count is None else count, standing=standing
        )
        trajectory = UnicycleTrajectory(
            bearing, gait.speed, gait.gain, direction, saturated
        )
        placements = np.zeros((schedule.count + 2, 3))
        placements[2:] = place_footsteps(
            trajectory,
            count=schedule.count,
            stride=gait.stride,
            foot_spacing=gait.foot_spacing,
            first_foot=first_foot,
        )
        placements[0] = swing_start or (
            0.0,
            gait.foot_spacing * first_foot.value,
            0.0,
        )
        inputs = _inputs(schedule, placements, state)
        return ManeuverPlan(
            schedule, bearing, direction, first_foot, placements, inputs
        )

    def plan_halt(
        self, *, first_foot: Foot, state: CenterState, swing_start: Pose
    ) -> ManeuverPlan:
        """Plan one last step that brings the feet abreast, and stand.

        Args:
            first_foot: Foot that lands.
            state: Present CoM in the frame of the support foot.
            swing_start: Pose of the swing foot in that frame.
        """
        schedule = self.schedule(1, standing=False)
        spacing = self.settings.foot_spacing * first_foot.value
        placements = np.array(
            [swing_start, (0.0, 0.0, 0.0), (0.0, spacing, 0.0)]
        )
        inputs = _inputs(schedule, placements, state)
        return ManeuverPlan(
            schedule, 0.0, Direction.FORWARD, first_foot, placements, inputs
        )


def _inputs(
    schedule: Schedule, placements: Array, state: CenterState | None
) -> Array:
    """Assemble what the constant maps are applied to."""
    gait = schedule.settings
    n = schedule.count
    inputs = np.zeros((n + 4, 2))
    theta = placements[1:, 2]
    ahead = gait.zmp_forward
    inputs[: n + 1, 0] = placements[1:, 0] + ahead * np.cos(theta)
    inputs[: n + 1, 1] = placements[1:, 1] + ahead * np.sin(theta)
    if state is None:
        if not schedule.standing:
            raise PlanError("state must be given unless the robot stands")
        state = CenterState(_midway(placements[0].tolist(), ahead), (0.0, 0.0))
    (x, y), (vx, vy) = state
    check_finite(x + y, "CoM position", "m")
    check_finite(vx + vy, "CoM velocity", "m/s")
    inputs[n + 1] = (x, y) if schedule.standing else inputs[0]
    inputs[-1] = x, y
    row = schedule.dcm_start_map
    planned = row @ inputs
    eta = gait.eta
    scale = 1.0 / float(row[n + 2])
    inputs[n + 2, 0] = (x + vx / eta - planned[0]) * scale
    inputs[n + 2, 1] = (y + vy / eta - planned[1]) * scale
    return inputs


def _midway(foot: list[float], ahead: float) -> tuple[float, float]:
    """Point midway between the anchors of the two feet, in [m]."""
    x, y, theta = foot
    return (
        0.5 * (x + ahead * cos(theta) + ahead),
        0.5 * (y + ahead * sin(theta)),
    )
