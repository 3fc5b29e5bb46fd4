"""Simulation of one game with its motion, or of many with their outcomes.

Both take the same steps (:mod:`.relative_motion`), of fourth order, in which
edges of the laws, the capture and the closest approach are located. A
saturated evader that slides on zero error turns with the line of sight, by
Filippov's rule, so there is no chattering.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import atan2, cos, hypot, inf, pi, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.errors import PlanError, check_bearing, check_positive
from ...core.poses import Array, Pose, wrap_angle, wrap_angles
from .circles import Circle, circles_of, fit_circle
from .unicycle_game import Unicycles, check_side

# Step size times the larger gain, in [rad]: 0.05 s at 0.5 /s. Eight games of
# 2,000 starts have the outcomes of a step of 0.0025 s, and closest approaches
# within 1e-7 m; twice the step gives 9e-7 m.
STEP_TIMES_GAIN = 0.025
CHUNK = 16_384  # games between two reports of progress
MAX_STEPS = 1e8  # of one game: some seconds of computing time
ROWS = 4096  # of a record
SAMPLES = 361  # of a path, to which a circle is fitted


@dataclass(frozen=True, slots=True)
class RelativeStart:
    r"""Relative coordinates of two unicycles; see :mod:`.relative_motion`.

    Attributes:
        distance: Distance :math:`r`, in [m].
        pursuer_error: Bearing :math:`a` of the evader in the pursuer's
            frame, which is the error of (2), in [rad].
        bearing: Bearing :math:`\psi` of the pursuer in the evader's frame,
            in [rad]; zero if the evader faces the pursuer.
    """

    distance: float
    pursuer_error: float = 0.0
    bearing: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.distance, "distance", "m")
        check_bearing(self.pursuer_error, "pursuer_error")
        check_bearing(self.bearing, "bearing")

    @classmethod
    def from_world(cls, pursuer: Pose, evader: Pose) -> "RelativeStart":
        """Compute relative coordinates of two poses in a common frame."""
        dx, dy = evader.x - pursuer.x, evader.y - pursuer.y
        sight = atan2(dy, dx)
        return cls(
            hypot(dx, dy),
            wrap_angle(sight - pursuer.theta),
            wrap_angle(sight + pi - evader.theta),
        )

    def wrapped(self) -> tuple[float, float, float]:
        """Return the distance [m] and both angles in [-pi, pi] [rad]."""
        a, psi = wrap_angle(self.pursuer_error), wrap_angle(self.bearing)
        return self.distance, a, psi

    def poses(self) -> tuple[Pose, Pose]:
        """Return the poses of both in the initial frame of the pursuer."""
        r, sight = self.distance, self.pursuer_error
        turned = sight + pi - self.bearing
        return Pose(0.0, 0.0, 0.0), Pose(
            r * cos(sight), r * sin(sight), turned
        )


@dataclass(frozen=True)
class PlayedGame:
    """Simulated game with dense output."""

    game: Unicycles  # parameters of the game
    captured: bool  # whether the distance fell to the capture distance
    end_time: float  # time of capture or end of the game, in [s]
    closest_distance: float  # closest approach, in [m]
    closest_time: float  # time of the closest approach, in [s]
    # Times of transitions between smooth pieces, in [s].
    switches: tuple[float, ...]
    sides: tuple[int, ...]  # side at the start and after each switch
    circle: Circle | None  # that it ends on, to 2 % and 0.02 rad
    _rows: Array = field(repr=False)  # some states of it, see relative_motion

    def states(self, times: ArrayLike) -> Array:
        """Evaluate the states at times between 0 and ``end_time``, in [s].

        Returns:
            Columns r [m], a, psi, direction of the line of sight [rad], x, y
            of the pursuer [m]. Shape (n, 6). The bearing psi may lie outside
            [-pi, pi] by less than a turn.
        """
        from . import relative_motion as motion  # imports Numba

        rules, step = motion.rules_of(self.game, 0.0), accurate_step(self.game)
        queries = np.atleast_1d(np.asarray(times, dtype=np.float64))
        index = np.searchsorted(self._rows[:, 0], queries, side="right")
        rows = self._rows[np.maximum(index - 1, 0)]
        nothing, circles = rows[:0], np.empty((0, 3))
        for row, time in zip(rows, queries, strict=True):
            motion.play_on(row, circles, step, time, rules, nothing)
        found: Array = rows[:, 1:7]
        return found

    def poses(self, times: ArrayLike) -> tuple[Array, Array]:
        """Evaluate the poses of pursuer and evader, likewise.

        The frame is the initial one of the pursuer.

        Returns:
            Poses (x [m], y [m], theta [rad]). Shape (n, 3) each.
        """
        r, a, psi, sight, x, y = self.states(times).T
        ends = x + r * np.cos(sight), y + r * np.sin(sight)
        pursuer = np.column_stack([x, y, sight - a])
        return pursuer, np.column_stack([*ends, sight + np.pi - psi])


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Outcomes of many games; every array has shape (n,)."""

    closest_distance: Array  # closest approach of each game, in [m]
    closest_time: Array  # time of the closest approach, in [s]
    # Whether the distance fell to the capture distance.
    captured: NDArray[np.bool_]
    capture_time: Array  # time of capture, in [s]; NaN without capture
    # Time after which the game stays within 2 % and 0.02 rad of a circle, in
    # [s]; inf if it does not, or is captured.
    settled_time: Array
    # Index of the final circle in circles_of(game); -1 for none.
    circle: NDArray[np.int64]
    states: Array  # final r [m], a, psi [rad]. Shape (n, 3)
    sides: NDArray[np.int64]  # final side. Shape (n,)

    def shares(self, count: int) -> list[float]:
        """Return the fraction of games that end on each of the circles."""
        numbers = np.bincount(self.circle + 1, minlength=count + 1)[1:]
        found: list[float] = (numbers / len(self.circle)).tolist()
        return found


@dataclass(frozen=True, slots=True)
class FittedCircle:
    """Circles fitted to two paths, with the quantities of ``Circle``.

    The distance is the final one, the turning rate the pursuer's mean.
    """

    radius_pursuer_m: float
    radius_evader_m: float
    distance_m: float
    turning_rate_rad_s: float
    headings_apart_rad: float
    motions_apart_rad: float
    centers_apart_m: float


def simulate(
    game: Unicycles,
    start: RelativeStart,
    duration: float,
    *,
    side: int = 0,
    capture_distance: float = 1e-6,
) -> PlayedGame:
    """Simulate one game.

    Args:
        game: Parameters of the game.
        start: Initial relative coordinates.
        duration: Time after which the game ends, in [s].
        side: Initial side, +1 or -1; 0 for the one behind the evader.
        capture_distance: Distance at which the game ends, in [m].

    Raises:
        StepAsideError: If a value is out of range.
    """
    from . import relative_motion as motion  # imports Numba

    step = _checked_step(game, duration, None, capture_distance, side)
    rules = motion.rules_of(game, capture_distance)
    circles = circles_of(game)
    played = np.zeros(motion.COLUMNS)
    motion.begin(played, start.wrapped(), side, rules)
    record, parts = np.empty((ROWS, motion.COLUMNS)), []
    while played[0] < duration and played[motion.CAPTURED] < 0.0:
        count = motion.play_on(
            played, _rows_of(circles), step, float(duration), rules, record
        )
        parts.append(record[:count].copy())
    rows = np.vstack([*parts, played])
    rows[:, motion.CAPTURED] = -1.0  # they can be played on
    passed = np.flatnonzero(np.diff(rows[:, motion.PASSED])) + 1
    on = int(played[motion.CIRCLE])
    return PlayedGame(
        game,
        bool(played[motion.CAPTURED] >= 0.0),
        float(played[motion.TIME]),
        float(played[motion.LEAST]),
        float(played[motion.WHEN]),
        tuple(rows[passed, motion.TIME].tolist()),
        tuple(rows[[0, *passed], motion.SIDE].astype(int).tolist()),
        circles[on] if on >= 0 else None,
        rows,
    )


def play_games(
    game: Unicycles,
    starts: ArrayLike,
    duration: float,
    *,
    step: float | None = None,
    capture_distance: float = 1e-6,
    side: int = 0,
    progress: Callable[[int], None] | None = None,
) -> Outcomes:
    """Simulate one game from each of many initial states.

    Args:
        game: Parameters of the game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        duration: Time after which a game ends, in [s].
        step: Step size of the integration, in [s]; by default that of
            :func:`accurate_step`. Steps end at the edges of the laws, and
            are shorter where the players are close.
        capture_distance: Distance at which a game ends, in [m].
        side: Initial side, +1 or -1; 0 for the one behind the evader.
        progress: Called with the number of games of each finished chunk of
            16,384.
    """
    from . import relative_motion as motion  # imports Numba

    step = _checked_step(game, duration, step, capture_distance, side)
    states = _wrapped(starts)
    rules = motion.rules_of(game, capture_distance)
    circles, end = _rows_of(circles_of(game)), float(duration)
    played = np.zeros((len(states), motion.COLUMNS))
    nothing = np.empty((0, motion.COLUMNS))
    for first in range(0, len(states), CHUNK):
        part, own = (each[first : first + CHUNK] for each in (played, states))
        motion.play_all(part, own, side, circles, step, end, rules, nothing)
        if progress is not None:
            progress(len(part))
    time, settled = played[:, motion.CAPTURED], played[:, motion.SETTLED]
    captured = time >= 0.0
    unsettled = captured | (played[:, motion.CIRCLE] < 0.0)
    return Outcomes(
        played[:, motion.LEAST],
        played[:, motion.WHEN],
        captured,
        np.where(captured, time, np.nan),
        np.where(unsettled, inf, settled),
        np.where(unsettled, -1, played[:, motion.CIRCLE]).astype(np.int64),
        played[:, 1:4],
        played[:, motion.SIDE].astype(np.int64),
    )


def accurate_step(game: Unicycles) -> float:
    """Return the step, in [s], that keeps closest approaches to 1e-7 m.

    At speeds of about 1 m/s.
    """
    return STEP_TIMES_GAIN / max(game.pursuer_gain, game.evader_gain)


def measure(run: PlayedGame) -> FittedCircle:
    """Fit circles to the last turn of a game, or its last tenth if shorter."""
    span = 0.1 * run.end_time
    if run.circle is not None:
        turn = 2.0 * pi / abs(run.circle.turning_rate_rad_s)
        span = min(turn, 0.5 * run.end_time)
    times = np.linspace(run.end_time - span, run.end_time, SAMPLES)
    pursuer, evader = run.poses(times)
    center_p, radius_p = fit_circle(pursuer[:, :2])
    center_e, radius_e = fit_circle(evader[:, :2])
    heading = float(pursuer[-1, 2] - evader[-1, 2])
    return FittedCircle(
        radius_p,
        radius_e,
        float(np.hypot(*(evader[-1, :2] - pursuer[-1, :2]))),
        float(pursuer[-1, 2] - pursuer[0, 2]) / span,
        abs(wrap_angle(heading)),
        abs(wrap_angle(heading + pi)),
        float(np.hypot(*(center_p - center_e))),
    )


def _checked_step(
    game: Unicycles,
    duration: float,
    step: float | None,
    capture: float,
    side: int,
) -> float:
    """Check the options of a simulation; return its step, in [s]."""
    check_positive(duration, "duration", "s")
    step = accurate_step(game) if step is None else step
    check_positive(step, "step", "s")
    check_positive(capture, "capture_distance", "m")
    check_side(side)
    if duration > MAX_STEPS * step:
        raise PlanError(
            f"duration must be at most {MAX_STEPS:g} steps of {step:g} [s], "
            f"got {duration:g} [s]"
        )
    return float(step)


def _rows_of(circles: tuple[Circle, ...]) -> Array:
    """Return rows of r [m], a, psi [rad] at side +1. Shape (n, 3)."""
    rows = [
        (c.distance_m, c.pursuer_error_rad, c.bearing_rad) for c in circles
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)


def _wrapped(starts: ArrayLike) -> Array:
    """Return initial states with wrapped angles. Shape (n, 3)."""
    states = np.array(starts, dtype=np.float64).reshape(-1, 3)
    if not (np.isfinite(states).all() and (states[:, 0] > 0.0).all()):
        raise PlanError("starts must be finite with distance > 0 [m]")
    angles = states[:, 1:]
    if angles.size:
        check_bearing(float(np.abs(angles).max()), "bearings of starts")
    far = np.abs(angles) > np.pi  # wrapping would turn pi into -pi
    angles[far] = wrap_angles(angles[far])
    return states
