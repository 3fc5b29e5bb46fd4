"""Verification of a bound by closed forms and by simulated games."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.poses import arc, rotate, wrap_angles
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
    """Simulate games of unicycles along exact arcs.

    Args:
        bound: Table of the game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        evader: Steering of the evader; by default the table's optimum.
        pursuer: Steering of the pursuer; by default the table's optimum, or
            its law.
        duration: Duration of a game, in [s]; by default the table's horizon.
        steps: Number of time steps, in which turning rates are held.

    Returns:
        Closest approach of each game, in [m]; games end at the least
        distance of the table. Shape (n,).
    """
    game = bound.game
    evader = bound.evader_turn if evader is None else evader
    pursuer = bound.pursuer_turn if pursuer is None else pursuer
    duration = bound.horizon if duration is None else duration
    step = duration / steps
    r, a, psi = np.array(starts, dtype=np.float64).T
    pursuer_pose = np.zeros((len(r), 3))
    evader_pose = np.column_stack([r * np.cos(a), r * np.sin(a), a - psi])
    least = r.copy()
    for _ in range(steps):
        turn_e, turn_p = evader(r, a, psi), pursuer(r, a, psi)
        limit = game.evader_turn
        turn_e = np.clip(turn_e, -limit, limit)
        _drive(evader_pose, game.evader_speed, turn_e, step)
        _drive(pursuer_pose, game.pursuer_speed, turn_p, step)
        dx, dy = (evader_pose[:, :2] - pursuer_pose[:, :2]).T
        r, sight = np.hypot(dx, dy), np.arctan2(dy, dx)
        a = wrap_angles(sight - pursuer_pose[:, 2])
        psi = wrap_angles(sight - evader_pose[:, 2])
        least = np.where(least > bound.grid.near, np.minimum(least, r), least)
    closest: Array = np.maximum(least, bound.grid.near)
    return closest


def fixed_angle_evader(bound: Bound, angle: float) -> Steering:
    """Return the evader of eq. (4) with the side behind it.

    Args:
        bound: Table of the game.
        angle: Evasion angle, in [rad]; MOVE_ASIDE is the paper's.

    Returns:
        Steering with the pursuer's gain, or with the gain that reaches the
        evader's limit at an error of pi.
    """
    gain = bound.game.pursuer_gain or bound.game.evader_turn / np.pi

    def steer(r: Array, a: Array, psi: Array) -> Array:
        side = np.where(psi < 0.0, 1.0, -1.0)
        turn: Array = gain * (psi + side * angle)
        return turn

    return steer


def random_evader(bound: Bound, seed: int, hold: int = 60) -> Steering:
    """Return an evader with piecewise constant random turning rates.

    Args:
        bound: Table of the game.
        seed: Seed of the random numbers.
        hold: Number of decisions between two draws.
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


def reference_evaders(bound: Bound) -> dict[str, Steering]:
    """Return evaders for comparison with the bound, by name."""
    return {
        "move aside": fixed_angle_evader(bound, MOVE_ASIDE),
        "move back": fixed_angle_evader(bound, MOVE_BACK),
        "straight on": lambda r, a, psi: np.zeros_like(r),
        "random": random_evader(bound, 0),
    }


def draw_starts(bound: Bound, count: int, seed: int) -> Array:
    """Draw states inside the grid, uniform in r, a and psi. Shape (n, 3)."""
    rng, grid = np.random.default_rng(seed), bound.grid
    reach = grid.near + 0.75 * (grid.far - grid.near)
    r = rng.uniform(grid.near, reach, count)
    angles = rng.uniform(-np.pi, np.pi, (count, 2))
    return np.column_stack([r, angles])


def _drive(poses: Array, speed: float, turn: Array, step: float) -> None:
    """Move poses along arcs, in place."""
    x, y, turned = arc(speed * step, 0.0, turn * step).T
    poses[:, :2] += rotate(x, y, poses[:, 2]).T
    poses[:, 2] += turned


PIECES = {1: "both turn in", 2: "straight last", 3: "same turn first"}


@dataclass(frozen=True, slots=True)
class BarrierCheck:
    """Errors of a table on the barrier of two identical cars.

    Attributes:
        states: Rows of r [m], a, psi [rad] on the closed-form barrier.
        pieces: Piece of each state, negative on the right half.
        value_errors: Value minus capture distance, in [m].
        distance_errors: Signed distance of the table's barrier from the
            state, in the pursuer's plane, to first order, in [m].
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
        capture: Capture distance, in [m].
        angles: Number of slices at constant angle between the motions.

    Raises:
        PlanError: If the cars differ.
    """
    states, pieces = barrier_states(bound.game, capture, angles)
    inside = states[:, 0] <= bound.grid.far
    states, pieces = states[inside], pieces[inside]
    r, a, psi = states.T
    errors = bound.value(r, a, psi) - capture
    # Gradient in the plane at constant angle between the motions.
    step = bound.grid.spacings[0]
    x, y, theta = r * np.cos(a), r * np.sin(a), a - psi

    def value(x: Array, y: Array) -> Array:
        sight = np.arctan2(y, x)
        return bound.value(np.hypot(x, y), sight, wrap_angles(sight - theta))

    slope = np.hypot(
        value(x + step, y) - value(x - step, y),
        value(x, y + step) - value(x, y - step),
    ) / (2.0 * step)
    distances = errors / np.maximum(slope, 1e-3)
    return BarrierCheck(states, pieces, errors, distances)


@dataclass(frozen=True, slots=True)
class BoundComparison:
    """Simulated games of one evader compared with the bound.

    Attributes:
        name: Name of the evader.
        closest: Mean closest approach, in [m].
        over_bound: Mean closest approach over the mean bound.
        mean_error: Mean of closest approach minus bound, in [m].
        most: 95th percentile of the magnitude of that difference, in [m].
        below: Largest shortfall below the bound, in [m].
        above: Largest excess above the bound, in [m].
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
    """Simulate the optimal evader of a table, and others for comparison.

    Args:
        bound: Table to be checked.
        games: Number of random initial states.
        seed: Seed of the initial states.
        starts: Initial states instead of random ones: rows of r [m], a, psi
            [rad].

    Returns:
        Comparisons, the optimal evader first.
    """
    if starts is None:
        starts = draw_starts(bound, games, seed)
    expected = bound.value(*starts.T)
    rows = []
    for name, evader in {"optimal": None, **reference_evaders(bound)}.items():
        closest = play_bound(bound, starts, evader)
        errors = closest - expected
        rows.append(
            BoundComparison(
                name,
                float(closest.mean()),
                float(closest.mean() / expected.mean()),
                float(errors.mean()),
                float(np.quantile(np.abs(errors), 0.95)),
                float(np.maximum(-errors, 0.0).max()),
                float(np.maximum(errors, 0.0).max()),
            )
        )
    return tuple(rows)
