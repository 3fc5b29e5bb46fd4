"""A bound beside closed forms and beside games that are played."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.poses import wrap_angles
from ..unicycle.unicycle_game import MOVE_ASIDE, MOVE_BACK
from .barrier import barrier_states
from .value_table import Bound

Array = NDArray[np.float64]
Steering = Callable[[Array, Array, Array], Array]
"""Turning rates [rad/s] from r [m], a and psi [rad], each of shape (n,)."""


def play_bound(
    bound: Bound,
    starts: Array,
    evader: Steering | None = None,
    pursuer: Steering | None = None,
    *,
    duration: float | None = None,
    steps: int = 1200,
) -> Array:
    """Play games with unicycles that drive along exact arcs.

    Args:
        bound: Table whose game is played.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        evader: Who evades; by default the best one of the table.
        pursuer: Who pursues; by default the best one, or the law.
        duration: Of a game, in [s]; by default the table's horizon.
        steps: Into which it is divided; turning rates are held in each.

    Returns:
        Least distance of each game, in [m]; games end at the least distance
        of the table. Shape (n,).
    """
    game = bound.game
    evader = bound.evader_turn if evader is None else evader
    pursuer = bound.pursuer_turn if pursuer is None else pursuer
    duration = bound.horizon if duration is None else duration
    step = duration / steps
    r, a, psi = np.array(starts, dtype=np.float64).T
    hunter = np.zeros((len(r), 3))
    prey = np.column_stack([r * np.cos(a), r * np.sin(a), a - psi])
    least = r.copy()
    for _ in range(steps):
        turn_e, turn_p = evader(r, a, psi), pursuer(r, a, psi)
        limit = game.evader_turn
        _drive(prey, game.evader_speed, np.clip(turn_e, -limit, limit), step)
        _drive(hunter, game.pursuer_speed, turn_p, step)
        dx, dy = (prey[:, :2] - hunter[:, :2]).T
        r, sight = np.hypot(dx, dy), np.arctan2(dy, dx)
        a, psi = (
            wrap_angles(sight - hunter[:, 2]),
            wrap_angles(sight - prey[:, 2]),
        )
        least = np.where(least > bound.grid.near, np.minimum(least, r), least)
    kept: Array = np.maximum(least, bound.grid.near)
    return kept


def moving(bound: Bound, angle: float) -> Steering:
    """Evader of eq. (4) with the side behind it, within its turning limit.

    Args:
        bound: Table whose game is played.
        angle: Evasion angle, in [rad]; MOVE_ASIDE is the paper's.

    Returns:
        The evader, with the pursuer's gain or one that goes with its limit.
    """
    gain = bound.game.pursuer_gain or bound.game.evader_turn / np.pi

    def steer(r: Array, a: Array, psi: Array) -> Array:
        side = np.where(psi < 0.0, 1.0, -1.0)
        turn: Array = gain * (psi + side * angle)
        return turn

    return steer


def wandering(bound: Bound, seed: int, hold: int = 60) -> Steering:
    """Evader that draws a turning rate, holds it, and draws again.

    Args:
        bound: Table whose game is played.
        seed: Of the draws.
        hold: Decisions between two draws.
    """
    rng, limit = np.random.default_rng(seed), bound.game.evader_turn
    drawn: list[Array] = []
    calls = 0

    def steer(r: Array, a: Array, psi: Array) -> Array:
        nonlocal calls
        if calls % hold == 0:
            drawn[:] = [rng.choice([-limit, 0.0, limit], len(r))]
        calls += 1
        return drawn[0]

    return steer


def other_evaders(bound: Bound) -> dict[str, Steering]:
    """Evaders that cannot do better than the bound, by name."""
    return {
        "move aside": moving(bound, MOVE_ASIDE),
        "move back": moving(bound, MOVE_BACK),
        "straight on": lambda r, a, psi: np.zeros_like(r),
        "random": wandering(bound, 0),
    }


def draw_starts(bound: Bound, count: int, seed: int) -> Array:
    """Random states inside the grid, all bearings alike; shape (n, 3)."""
    rng, grid = np.random.default_rng(seed), bound.grid
    reach = grid.near + 0.75 * (grid.far - grid.near)
    r = rng.uniform(grid.near, reach, count)
    angles = rng.uniform(-np.pi, np.pi, (count, 2))
    return np.column_stack([r, angles])


def _drive(poses: Array, speed: float, turn: Array, step: float) -> None:
    """Move poses along arcs, in place."""
    half = 0.5 * turn * step
    along = speed * step * np.sinc(half / np.pi)
    poses[:, 0] += along * np.cos(poses[:, 2] + half)
    poses[:, 1] += along * np.sin(poses[:, 2] + half)
    poses[:, 2] += 2.0 * half


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
class BoundComparison:
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
) -> tuple[BoundComparison, ...]:
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
            BoundComparison(
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
