"""Many games at once: compiled where Numba is installed, else NumPy."""

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import PlanError, check_positive
from ..poses import wrap_angles
from .circles import circles_of
from .laws import Game

Array = NDArray[np.float64]
NEAR = 0.02  # off a circle by less than 2 % and 0.02 rad is "on it"


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
    from . import compiled
    from . import compiled_batch as blocks
    from . import event_located as careful
    from . import numpy_batch as plain

    check_positive(duration, "duration", "s")
    check_positive(step, "step", "s")
    check_positive(capture_distance, "capture_distance", "m")
    if backend not in ("auto", "numba", "numpy"):
        raise PlanError(f"backend must be auto, numba or numpy, got {backend}")
    if backend == "numba" and not compiled.AVAILABLE:
        raise PlanError("backend numba is not installed; pip install numba")
    fast = compiled.AVAILABLE and backend != "numpy"
    play = blocks.play_blocks if fast else plain.play_arrays

    state = np.array(starts, dtype=np.float64).reshape(-1, 3)
    if not (np.isfinite(state).all() and (state[:, 0] > 0.0).all()):
        raise PlanError("starts must be finite with distance > 0 [m]")
    angles = state[:, 1:]
    far = np.abs(angles) > np.pi  # wrapping would turn pi into -pi
    angles[far] = wrap_angles(angles[far])
    vp, ve = game.pursuer.speed, game.evader.speed
    kp, ke = game.pursuer.gain, game.evader.gain
    sides = np.empty(len(state), dtype=np.int64)
    branches = np.empty(len(state), dtype=np.int64)
    careful.enter_all(
        state,
        sides,
        branches,
        vp,
        ve,
        side,
        game.angle,
        game.keeps_side,
        game.saturated,
        ke,
    )
    out = np.empty((len(state), 4))  # closest, its time, capture, settled
    out[:, 0], out[:, 1:] = state[:, 0], (0.0, -1.0, 0.0)
    out[state[:, 0] <= capture_distance, 2] = 0.0
    circles = np.array(
        [
            (c.distance_m, c.pursuer_error_rad, c.bearing_rad)
            for c in circles_of(game)
        ]
    ).reshape(-1, 3)
    count = ceil(duration / step - 1e-9)
    c1 = 0.0 if game.saturated else ke
    laws = (vp, ve, kp, ke, c1, game.angle, game.hysteresis)
    for first in range(0, len(state), chunk):
        part = slice(first, first + chunk)
        play(
            state[part],
            sides[part],
            branches[part],
            out[part],
            count,
            step,
            laws,
            game.keeps_side,
            capture_distance,
            circles,
            NEAR,
        )
        if progress is not None:
            progress(min(chunk, len(state) - first))
    captured = out[:, 2] >= 0.0
    unsettled = captured | (out[:, 3] >= count * step * (1.0 - 1e-12))
    off = plain.distances_off(circles, sides, *state.T)
    nearest = off.argmin(axis=0) if len(circles) else sides
    return Outcomes(
        out[:, 0],
        out[:, 1],
        captured,
        np.where(captured, out[:, 2], np.nan),
        np.where(unsettled, inf, out[:, 3]),
        np.where(unsettled, -1, nearest),
        state,
        sides,
    )
