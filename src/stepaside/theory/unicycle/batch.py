"""Simulation of many games, from arrays of initial states."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.brief_repr import brief_repr
from ...core.errors import PlanError, check_bearing, check_positive
from ...core.poses import wrap_angles
from .circles import Circle, circles_of
from .relative_motion import RelativeState, deviation, rules_of
from .unicycle_game import Game, check_side

Array = NDArray[np.float64]

# Step size times the larger gain, in [rad]: 0.05 s at 0.5 /s. Eight games of
# 2,000 starts have the outcomes of a step of 0.0025 s, and closest approaches
# within 1e-7 m; twice the step gives 9e-7 m.
STEP_TIMES_GAIN = 0.025
CHUNK = 16_384  # games between two reports of progress
MAX_STEPS = 1e8  # of one game: some seconds of computing time


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Outcomes of many games; every array has shape (n,)."""

    __repr__ = brief_repr

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


def play_games(
    game: Game,
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
        duration: Time after which a game ends, in [s]; rounded up to whole
            steps of a given size.
        step: Step size of the integration, in [s]; by default the largest
            one up to :func:`accurate_step` that divides the duration. Steps
            near an edge, a capture or a close pass are divided further.
        capture_distance: Distance at which a game ends, in [m].
        side: Initial side, +1 or -1; 0 for the one behind the evader.
        progress: Called with the number of games of each finished chunk of
            16,384.
    """
    from .batch_kernel import play_all  # imports Numba

    check_positive(duration, "duration", "s")
    if step is None:
        step = duration / ceil(duration / accurate_step(game) - 1e-9)
    check_positive(step, "step", "s")
    check_positive(capture_distance, "capture_distance", "m")
    check_side(side)
    if duration > MAX_STEPS * step:
        raise PlanError(
            f"duration must be at most {MAX_STEPS:g} steps of {step:g} [s], "
            f"got {duration:g} [s]"
        )
    states = _wrapped(starts)
    circles = circle_states(circles_of(game))
    steps = ceil(duration / step - 1e-9)
    rules = rules_of(game, capture_distance)
    played = np.zeros((len(states), 8))
    played[:, :3] = states
    for first in range(0, len(states), CHUNK):
        part = played[first : first + CHUNK]
        play_all(part, side, circles, steps, float(step), rules)
        if progress is not None:
            progress(len(part))
    return _outcomes(played, circles, steps * step)


def accurate_step(game: Game) -> float:
    """Return the step, in [s], that keeps closest approaches to 1e-7 m.

    At speeds of about 1 m/s.
    """
    return STEP_TIMES_GAIN / max(game.pursuer.gain, game.evader.gain)


def circle_states(circles: Sequence[Circle]) -> Array:
    """Return rows of r [m], a, psi [rad] at side +1. Shape (n, 3)."""
    rows = [
        (c.distance_m, c.pursuer_error_rad, c.bearing_rad) for c in circles
    ]
    return np.array(rows).reshape(-1, 3)


def circle_deviations(
    circles: Array, states: Array, sides: ArrayLike
) -> Array:
    """Return the largest deviations (n, m) of states from circles.

    Both are rows of r [m], a, psi [rad], the circles at side +1. Shapes
    (n, 3), (m, 3).
    """
    circle, state = RelativeState(*circles.T[..., None]), states.T
    found: Array = deviation(RelativeState(*state), np.asarray(sides), circle)
    return found


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


def _outcomes(played: Array, circles: Array, end: float) -> Outcomes:
    """Return the outcomes of rows of :func:`.batch_kernel.play_all`."""
    states = played[:, :3].copy()
    side, closest, when, capture, settled = played[:, 3:].T
    captured = capture >= 0.0
    unsettled = captured | (settled >= end * (1.0 - 1e-12))
    nearest = np.zeros(len(states), dtype=np.int64)
    if len(circles):
        nearest = circle_deviations(circles, states, side).argmin(axis=0)
    return Outcomes(
        closest.copy(),
        when.copy(),
        captured,
        np.where(captured, capture, np.nan),
        np.where(unsettled, inf, settled),
        np.where(unsettled, -1, nearest),
        states,
        side.astype(np.int64),
    )
