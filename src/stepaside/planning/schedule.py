"""Phases of a maneuver, with the constant linear maps of their timing.

For fixed durations, the planned motion is linear in a few points: the anchors
(ZMP position in each foot), the amplitude of the initial correction, and the
initial CoM. So the closed form is solved once for unit inputs, and a plan is
a few small matrix products.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.poses import Array
from .com import BoundedCom, PiecewisePolynomial, evaluate
from .gait_settings import GaitSettings, SwingProfile

DEGREE = 3

_PROGRESS: dict[SwingProfile, tuple[float, ...]] = {
    "minimum-jerk": (0.0, 0.0, 0.0, 10.0, -15.0, 6.0),
    "even": tuple(
        70.0 / 3.0 * c for c in (0.0, 0.0, 0.0, 1.0, -3.5, 5.4, -4.0, 8.0 / 7)
    ),
}
"""Coefficients of the progress, by powers of the phase."""


def swing_progress(phase: Any, profile: SwingProfile = "minimum-jerk") -> Any:
    """Return the fraction of the path that a swing foot has covered.

    Velocity and acceleration vanish at both ends. The minimum-jerk polynomial
    peaks half-way at 15/8 of the mean velocity, the even one at 35/24.
    """
    if isinstance(phase, float):
        s = min(max(phase, 0.0), 1.0)
    else:
        s = np.clip(phase, 0.0, 1.0)
    if profile == "minimum-jerk":
        return s**3 * (10.0 + s * (6.0 * s - 15.0))
    # From the nearer end: the coefficients sum to 1 only up to rounding.
    near, part = 0.5 - abs(s - 0.5), 0.0 * s
    for coefficient in reversed(_PROGRESS[profile]):
        part = coefficient + part * near
    return part + (s > 0.5) * (1.0 - 2.0 * part)


def swing_acceleration(profile: SwingProfile) -> Array:
    """Return the second derivative of the progress, by powers of the phase."""
    progress = np.array(_PROGRESS[profile], dtype=np.float64)
    powers = np.arange(progress.size)
    acceleration: Array = (progress * powers * (powers - 1))[2:]
    return acceleration


def swing_height(
    phase: ArrayLike, apex: float, profile: SwingProfile = "minimum-jerk"
) -> Array:
    """Return the height of a swing foot, in [m]; its apex is half-way."""
    s = np.clip(phase, 0.0, 1.0)
    power = 2 if profile == "even" else 3
    height: Array = apex * (4.0 * s * (1.0 - s)) ** power
    return height


@dataclass(frozen=True, slots=True)
class Sampler:
    """Linear maps from the inputs of a plan to its samples at fixed times."""

    times: Array  # times since the plan began [s]. Shape (m,)
    # to ZMP, DCM, CoM, and pivot if it differs. Shape (3 m or 4 m, inputs)
    pendulum: Array
    # from placements to first support and swing foot. (2 m, placements)
    feet: Array
    support_height: Array  # height of the first support foot [m]. Shape (m,)
    swing_height: Array  # height of the first swing foot [m]. Shape (m,)


class Schedule:
    r"""Timing of ``count`` footsteps, and its constant maps.

    The pieces are: when starting from standing, a double support that takes
    the ZMP from under the CoM to the first support foot; then, for each
    footstep, a single support with the ZMP at rest and a double support
    that takes it to the landed foot; the last one takes it midway between
    the last two feet, where the robot can stand.

    The *inputs* of the maps are, in this order: the ``count + 1`` anchors of
    the support foot and the footsteps, the ZMP at the start (equal to the
    first anchor when walking), the amplitude of the correction, the CoM at
    the start.

    The *correction* is a ZMP shift :math:`\frac{27}{4} a\, s (1 - s)^2` over
    the first piece (s: its phase), which is zero at both ends, so that
    position, velocity and acceleration of the CoM stay continuous from one
    plan to the next.
    """

    def __init__(
        self, settings: GaitSettings, count: int, *, standing: bool
    ) -> None:
        self.settings = settings
        self.count = count
        self.standing = standing
        walk = [settings.single_support, settings.double_support] * count
        first = [settings.start_support] if standing else []
        self.durations = np.array(first + walk)
        self.starts = np.concatenate([[0.0], np.cumsum(self.durations)])
        self.has_swing_reaction = settings.swing_reaction > 0.0
        self.input_count = count + 4 + self.has_swing_reaction

    @property
    def duration(self) -> float:
        """Time from the start to the end of the last piece, in [s]."""
        return float(self.starts[-1])

    @property
    def first_step_duration(self) -> float:
        """Time from the start to the end of the first step, in [s]."""
        return float(self.starts[3 if self.standing else 2])

    @cached_property
    def zmp_map(self) -> PiecewisePolynomial:
        """ZMP of unit inputs: coefficients (4, pieces, inputs)."""
        n, pieces = self.count, self.durations.size
        w = np.zeros((DEGREE + 1, pieces, self.input_count))
        first = 1 if self.standing else 0
        unit = np.eye(self.input_count)

        def join(piece: int, start: Array, end: Array) -> None:
            w[0, piece] = start
            w[1, piece] = (end - start) / self.durations[piece]

        if self.standing:
            join(0, unit[n + 1], unit[0])
        for i in range(n):
            single = first + 2 * i
            w[0, single] = unit[i]
            last = 0.5 * (unit[i] + unit[i + 1])
            join(single + 1, unit[i], unit[i + 1] if i < n - 1 else last)
        bump = 6.75 * np.array([0.0, 1.0, -2.0, 1.0])
        w[:, 0, -2] = bump / self.durations[0] ** np.arange(DEGREE + 1)
        return PiecewisePolynomial(self.durations, w)

    @cached_property
    def pivot_map(self) -> PiecewisePolynomial:
        """Pivot of unit inputs: coefficients (degree + 1, pieces, inputs)."""
        zmp, gait = self.zmp_map, self.settings
        if not self.has_swing_reaction:
            return zmp
        duration = gait.single_support
        acceleration = swing_acceleration(gait.swing_profile)
        powers = np.arange(acceleration.size)
        # Polynomial in the time since lift-off, for a stride of 1 m, in [m].
        acceleration = (
            gait.swing_reaction * acceleration / duration ** (powers + 2.0)
        )
        w = np.zeros(
            (max(DEGREE + 1, acceleration.size), *zmp.coefficients.shape[1:])
        )
        w[: DEGREE + 1] = zmp.coefficients
        first = 1 if self.standing else 0
        for i in range(self.count):
            lifted = i - 1 if i > 0 else self.count + 2
            w[: acceleration.size, first + 2 * i, i + 1] -= acceleration
            w[: acceleration.size, first + 2 * i, lifted] += acceleration
        return PiecewisePolynomial(self.durations, w)

    @cached_property
    def pendulum_map(self) -> BoundedCom:
        """Closed form for unit inputs."""
        com_start = np.zeros(self.input_count)
        com_start[-1] = 1.0
        return BoundedCom.solve(self.pivot_map, self.settings.eta, com_start)

    @cached_property
    def dcm_start_map(self) -> Array:
        """Row that maps the inputs to the DCM at the start, eq. (16)."""
        _, dcm, _ = self.pendulum_map.sample([0.0])
        row: Array = dcm[0]
        return row

    @cached_property
    def first_step_sampler(self) -> Sampler:
        """Sampler of the instant at which the first step ends."""
        return self.sampler([self.first_step_duration])

    def swing_phases(self, times: Array) -> tuple[np.ndarray, Array]:
        """Return the step index and swing phase of each time.

        Phases are below 0 before single support and above 1 after it.
        """
        s = self.settings
        walked = times - (s.start_support if self.standing else 0.0)
        step = np.floor(walked / s.step_duration).astype(int)
        step = np.clip(step, 0, self.count - 1)
        return step, (walked - step * s.step_duration) / s.single_support

    def sampler(self, times: ArrayLike) -> Sampler:
        """Build the maps to samples at times since the plan began, in [s]."""
        t = np.asarray(times, dtype=np.float64)
        pivot, dcm, com = self.pendulum_map.sample(t)
        zmp, maps = pivot, [dcm, com]
        if self.has_swing_reaction:
            index, local = self.zmp_map.locate(t)
            local = np.minimum(local, self.durations[index])
            zmp = evaluate(self.zmp_map.coefficients[:, index], local)
            maps.append(pivot)
        pendulum = np.concatenate([zmp, *maps])
        step, phase = self.swing_phases(t)
        gait = self.settings
        progress = swing_progress(phase, gait.swing_profile)
        lift = swing_height(phase, gait.step_height, gait.swing_profile)
        m = t.size
        # Row j of the placements: swing foot at the start, support foot, then
        # the footsteps. Step i takes a foot from row i to row i + 2.
        feet = np.zeros((2, m, self.count + 2))
        rows = np.arange(m)
        even = step % 2 == 0
        moving = np.where(even, 1, 0)  # 1: the foot that swings first
        feet[moving, rows, step] = 1.0 - progress
        feet[moving, rows, step + 2] = progress
        feet[1 - moving, rows, step + 1] = 1.0
        return Sampler(
            t,
            pendulum,
            feet.reshape(2 * m, self.count + 2),
            np.where(even, 0.0, lift),
            np.where(even, lift, 0.0),
        )
