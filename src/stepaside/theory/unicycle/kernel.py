"""Many games at once: compiled where Numba is installed, else NumPy."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.brief_repr import brief_repr
from ...core.errors import PlanError, check_positive, shown
from ...core.poses import wrap_angles
from .all_circles import circles_of
from .circle_equations import Circle
from .compilation import load_numba
from .game_batch import Array, BatchTiming, deviations
from .game_parameters import rules_of
from .relative_coordinates import check_bearings
from .relative_motion import RelativeState
from .unicycle_game import Game

MOST_STEPS = 1e8  # of one game: some seconds of a fast machine
_RESULTS = (
    *RelativeState._fields,
    *("side", "closest", "closest_time", "capture_time", "settled"),
)


@dataclass(frozen=True, slots=True)
class Outcomes:
    """How many games ended; every array has shape (n,).

    Attributes:
        closest_distance: Least distance of each game, in [m].
        closest_time: When that was, in [s].
        captured: Whether the distance fell to the capture distance.
        capture_time: When that was, in [s]; NaN where not.
        settled_time: Time after which the game stays within 2 % and 0.02 rad
            of a circle, in [s]; inf where it does not, or was captured.
        circle: Which of ``circles_of(game)`` it has settled on; -1 for none.
        states: Last r [m], a, psi [rad]. Shape (n, 3).
        sides: Last side. Shape (n,).
    """

    __repr__ = brief_repr

    closest_distance: Array
    closest_time: Array
    captured: NDArray[np.bool_]
    capture_time: Array
    settled_time: Array
    circle: NDArray[np.int64]
    states: Array
    sides: NDArray[np.int64]


def play_games(
    game: Game,
    starts: ArrayLike,
    duration: float,
    *,
    step: float = 0.01,
    capture_distance: float = 1e-6,
    side: int = 0,
    backend: str = "auto",
    progress: Callable[[int], None] | None = None,
    chunk: int = 16384,
) -> Outcomes:
    """Play one game from each of many starts.

    Args:
        game: Parameters of the game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        duration: Time after which a game ends, in [s]; rounded up to whole
            steps.
        step: Step of the integration, in [s]. Steps near an edge, a capture
            or a close pass are cut further.
        capture_distance: Distance at which a game ends, in [m].
        side: Side at the start, +1 or -1; 0 for the one behind the evader.
        backend: "numba", "numpy", or "auto" for the first that is there.
        progress: Called with the number of games done after each chunk.
        chunk: Games between two calls of ``progress``.

    Returns:
        The outcome of every game, in the order of the starts.

    Raises:
        PlanError: If a value is out of its range, or a backend is not there.
    """
    from . import compiled_batch, numpy_batch  # which import Numba
    from .block_layout import lay_blocks

    check_positive(duration, "duration", "s")
    check_positive(step, "step", "s")
    check_positive(capture_distance, "capture_distance", "m")
    if duration > MOST_STEPS * step:
        raise PlanError(
            f"duration must be at most {MOST_STEPS:g} steps of {step:g} [s], "
            f"or it does not end, got {duration:g}"
        )
    fast = _compiles(backend)
    play = compiled_batch.play_blocks if fast else numpy_batch.play_blocks
    states = _wrapped(starts)
    circles = circles_of(game)
    rows = circle_states(circles)
    clock = BatchTiming(ceil(duration / step - 1e-9), float(step))
    rules = rules_of(game, capture_distance)
    played = np.empty((len(_RESULTS), len(states)))
    for first in range(0, len(states), chunk):
        part = states[first : first + chunk]
        size = compiled_batch.SIZE if fast else len(part)
        blocks = lay_blocks(part, side, size, clock.step, rules)
        play(blocks, rows, clock, rules)
        for row, name in zip(played, _RESULTS, strict=True):
            row[first : first + chunk] = blocks[name].ravel()[: len(part)]
        if progress is not None:
            progress(len(part))
    return _outcomes(played, rows, clock)


def circle_states(circles: Sequence[Circle]) -> Array:
    """Rows of r [m], a, psi [rad] on circles at side +1. Shape (n, 3)."""
    rows = [
        (c.distance_m, c.pursuer_error_rad, c.bearing_rad) for c in circles
    ]
    return np.array(rows).reshape(-1, 3)


def circles_off(circles: Array, states: Array, sides: ArrayLike) -> Array:
    """How far states are off each circle, as a share of it or in [rad].

    Args:
        circles: Rows of r [m], a, psi [rad] at side +1. Shape (n, 3).
        states: Rows of r [m], a, psi [rad]. Shape (m, 3).
        sides: Side of each state. Shape (m,).

    Returns:
        The largest of the three deviations. Shape (n, m).
    """
    circle = RelativeState(*circles.T[..., None])
    off = deviations(RelativeState(*states.T), np.asarray(sides), circle)
    largest: Array = np.max(off, axis=0)
    return largest


def _compiles(backend: str) -> bool:
    """Whether a backend is the compiled one."""
    if backend not in ("auto", "numba", "numpy"):
        raise PlanError(f"backend must be auto, numba or numpy, got {backend}")
    if backend == "numba" and load_numba() is None:
        raise PlanError(
            "backend numba needs numba: pip install 'stepaside[fast]'"
        )
    return backend != "numpy" and load_numba() is not None


def _wrapped(starts: ArrayLike) -> Array:
    """Starts with both angles wrapped. Shape (n, 3)."""
    try:
        states = np.array(starts, dtype=np.float64).reshape(-1, 3)
    except (TypeError, ValueError, OverflowError) as error:
        raise PlanError(
            "starts must be rows of distance [m] and two bearings [rad], got "
            f"{shown(starts)}"
        ) from error
    if not (np.isfinite(states).all() and (states[:, 0] > 0.0).all()):
        raise PlanError("starts must be finite with distance > 0 [m]")
    angles = states[:, 1:]
    check_bearings(angles, "bearings of starts")
    far = np.abs(angles) > np.pi  # wrapping would turn pi into -pi
    angles[far] = wrap_angles(angles[far])
    return states


def _outcomes(played: Array, circles: Array, clock: BatchTiming) -> Outcomes:
    """Outcomes of games from what their blocks hold at the end."""
    r, a, psi, side, closest, closest_time, capture_time, settled = played
    end = clock.steps * clock.step
    ends = r < closest
    captured = capture_time >= 0.0
    unsettled = captured | (settled >= end * (1.0 - 1e-12))
    states = np.stack([r, a, psi], axis=-1)
    nearest = np.zeros(len(r), dtype=np.int64)
    if len(circles):
        nearest = circles_off(circles, states, side).argmin(axis=0)
    return Outcomes(
        np.where(ends, r, closest),
        np.where(ends, end, closest_time),
        captured,
        np.where(captured, capture_time, np.nan),
        np.where(unsettled, inf, settled),
        np.where(unsettled, -1, nearest),
        states,
        side.astype(np.int64),
    )
