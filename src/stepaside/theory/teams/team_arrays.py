"""Simulation of games of several unicycles in NumPy, without Numba."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.poses import Array, wrap_angles
from .team_players import NEAREST, TeamRules

State = tuple[Array, Array, Array]  # x, y, theta


class _Begin(NamedTuple):
    """State of all games at the begin of a step. Shapes (players, games).

    Attributes:
        theta: Headings, in [rad].
        dx: Line of sight to the target, in [m].
        dy: Likewise.
        error: Errors of the headings, in [rad].
        targets: Numbers of the targets.
    """

    theta: Array
    dx: Array
    dy: Array
    error: Array
    targets: NDArray[np.int64]


def play_chunk(
    starts: Array, rules: TeamRules, steps: int, step: float
) -> tuple[Array, Array]:
    """Play games to the end.

    Args:
        starts: Initial poses. Shape (games, players, 3).
        rules: Parameters of the players.
        steps: Number of steps.
        step: Step size, in [s].

    Returns:
        Closest approaches and final poses, as in :class:`.TeamOutcomes`.
    """
    x, y, theta = (starts[:, :, i].T.copy() for i in range(3))
    games, count = starts.shape[:2]
    least = np.full((count, count, games), np.inf)
    _note_pairs(least, x, y)
    for _ in range(steps):
        targets = _targets_of(x, y, rules)
        dx, dy = _at(x, targets) - x, _at(y, targets) - y
        sight = np.arctan2(dy, dx)
        psi = wrap_angles(sight - theta)
        side = np.where(psi > 0.0, -1.0, 1.0)
        error = wrap_angles(psi + side * rules.angles[:, None])
        begin = _Begin(theta, dx, dy, error, targets)
        x, y, theta = _rk4((x, y, theta), begin, rules, step)
        _note_pairs(least, x, y)
    closest = np.sqrt(least).transpose(2, 0, 1)
    return closest, np.stack([x.T, y.T, theta.T], axis=-1)


def _at(values: Array, targets: NDArray[np.int64]) -> Array:
    """Return the value of each player's target. Shape (players, games)."""
    found: Array = np.take_along_axis(values, targets, axis=0)
    return found


def _targets_of(x: Array, y: Array, rules: TeamRules) -> NDArray[np.int64]:
    """Return the target of each player in each game."""
    targets = np.empty(x.shape, dtype=np.int64)
    for i, target in enumerate(rules.targets):
        if target != NEAREST:
            targets[i] = target
            continue
        opposed = np.flatnonzero(rules.evades != rules.evades[i])
        square = (x[opposed] - x[i]) ** 2 + (y[opposed] - y[i]) ** 2
        targets[i] = opposed[square.argmin(axis=0)]
    return targets


def _slope(state: State, begin: _Begin, rules: TeamRules) -> State:
    """Return the rates of all states."""
    x, y, theta = state
    dx, dy = _at(x, begin.targets) - x, _at(y, begin.targets) - y
    swept = np.arctan2(
        begin.dx * dy - begin.dy * dx, begin.dx * dx + begin.dy * dy
    )
    # Continuous within the step, unlike a wrapped error.
    error = begin.error + swept - (theta - begin.theta)
    velocities = rules.velocities[:, None]
    return (
        velocities * np.cos(theta),
        velocities * np.sin(theta),
        rules.gains[:, None] * error,
    )


def _rk4(state: State, begin: _Begin, rules: TeamRules, step: float) -> State:
    """Return the states after one step."""

    def moved(slope: State, time: float) -> State:
        x, y, theta = (
            value + time * rate
            for value, rate in zip(state, slope, strict=True)
        )
        return x, y, theta

    first = _slope(state, begin, rules)
    second = _slope(moved(first, 0.5 * step), begin, rules)
    third = _slope(moved(second, 0.5 * step), begin, rules)
    fourth = _slope(moved(third, step), begin, rules)
    mean = tuple(
        (a + 2.0 * (b + c) + d) / 6.0
        for a, b, c, d in zip(first, second, third, fourth, strict=True)
    )
    return moved(mean, step)  # type: ignore[arg-type]


def _note_pairs(least: Array, x: Array, y: Array) -> None:
    """Update the smallest squared distances of all pairs."""
    for i in range(len(x)):
        for j in range(i):
            square = (x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2
            np.minimum(least[i, j], square, out=least[i, j])
            least[j, i] = least[i, j]
