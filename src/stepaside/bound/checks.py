"""A bound beside closed forms and beside games that are played."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..poses import wrap_angles
from .barrier import barrier_states
from .rollout import draw_starts, other_evaders, play_bound
from .table import Bound

Array = NDArray[np.float64]
PIECES = {1: "both turn in", 2: "straight last", 3: "same turn first"}


@dataclass(frozen=True, slots=True)
class BarrierCheck:
    """The table at points of the barrier of two identical cars.

    Attributes:
        states: Rows of r [m], a, psi [rad] on the closed-form barrier.
        pieces: Piece of each, negative on the right half.
        value_errors: Value less the distance of capture, in [m].
        distance_errors: How far the table's barrier is from the point, in
            the pursuer's plane, to first order, in [m].
    """

    states: Array
    pieces: Array
    value_errors: Array
    distance_errors: Array


def check_barrier(
    bound: Bound, capture: float, angles: int = 18
) -> BarrierCheck:
    """Evaluate a table on the closed-form barrier.

    Args:
        bound: Table of two identical cars.
        capture: Distance of capture, in [m].
        angles: Number of slices of equal angle between the motions.

    Raises:
        PlanError: If the cars differ.
    """
    states, pieces = barrier_states(bound.game, capture, angles)
    inside = states[:, 0] <= bound.grid.far
    states, pieces = states[inside], pieces[inside]
    r, a, psi = states.T
    errors = bound.value(r, a, psi) - capture
    # slope in the plane at constant angle between the motions
    step = bound.grid.spacings[0]
    x, y, theta = r * np.cos(a), r * np.sin(a), a - psi

    def value(x: Array, y: Array) -> Array:
        sight = np.arctan2(y, x)
        return bound.value(np.hypot(x, y), sight, wrap_angles(sight - theta))

    slope = np.hypot(
        value(x + step, y) - value(x - step, y),
        value(x, y + step) - value(x, y - step),
    ) / (2.0 * step)
    apart = errors / np.maximum(slope, 1e-3)
    return BarrierCheck(states, pieces, errors, apart)


@dataclass(frozen=True, slots=True)
class Played:
    """Games of one evader beside the table.

    Attributes:
        name: Of the evader.
        closest: Mean least distance, in [m].
        over_bound: The same over the mean of the bound.
        mean_error: Mean of the least distance less the bound, in [m].
        most: What 95 % of its magnitudes keep below, in [m].
        below: Most that a game ends below the bound, in [m].
        above: Most that a game ends above it, in [m].
    """

    name: str
    closest: float
    over_bound: float
    mean_error: float
    most: float
    below: float
    above: float


def check_by_playing(
    bound: Bound, games: int, seed: int = 0, starts: Array | None = None
) -> tuple[Played, ...]:
    """Play the best evader of a table, and others that must not beat it.

    Args:
        bound: Table to be checked.
        games: Number of random starts.
        seed: Of the starts.
        starts: Starts instead of random ones: rows of r [m], a, psi [rad].

    Returns:
        The best evader first.
    """
    if starts is None:
        starts = draw_starts(bound, games, seed)
    promised = bound.value(*starts.T)
    rows = []
    for name, evader in {"optimal": None, **other_evaders(bound)}.items():
        kept = play_bound(bound, starts, evader)
        off = kept - promised
        rows.append(
            Played(
                name,
                float(kept.mean()),
                float(kept.mean() / promised.mean()),
                float(off.mean()),
                float(np.quantile(np.abs(off), 0.95)),
                float(np.maximum(-off, 0.0).max()),
                float(np.maximum(off, 0.0).max()),
            )
        )
    return tuple(rows)
