"""Games over grids of initial states, and from random ones."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.poses import Array
from .circles import settling_time
from .simulation import Outcomes, RelativeStart, play_games
from .unicycle_game import Unicycles

_CANDIDATES = 4  # local minima of the grid that are refined
_GAMES = 150  # of the refinement of one of them
NEAREST, FARTHEST = 0.3, 4.0  # random distances, in units of the game
_LONGEST = 400.0  # longest game, in units of one over the smaller gain


@dataclass(frozen=True, slots=True)
class StartMap:
    """Outcomes of games over a grid of initial states."""

    # Distances [m], errors of the pursuer and bearings of it [rad].
    axes: tuple[Array, Array, Array]
    outcomes: Outcomes  # outcomes of all games, in C order over the axes

    def grid(self, name: str) -> Array:
        """Return a field of the outcomes over the grid."""
        shape = [len(axis) for axis in self.axes]
        values: Array = getattr(self.outcomes, name).reshape(shape)
        return values


def map_starts(
    game: Unicycles,
    axes: tuple[Array, Array, Array],
    duration: float,
    **options: Any,
) -> StartMap:
    """Play a game from every point of a grid of initial states.

    Args:
        game: Parameters of the game.
        axes: Ascending values along the axes of :class:`StartMap`.
        duration: Duration of each game, in [s].
        options: Options of :func:`.play_games`.
    """
    starts = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    outcomes = play_games(game, starts.reshape(-1, 3), duration, **options)
    return StartMap(axes, outcomes)


def find_worst_start(
    game: Unicycles, found: StartMap, duration: float, **options: Any
) -> tuple[RelativeStart, float]:
    """Search the start with the closest approach, in [m], within a map.

    Its lowest local minima are moved by the Nelder-Mead simplex method.
    Arguments are those of :func:`map_starts`.
    """
    from scipy.ndimage import minimum_filter
    from scipy.optimize import minimize

    low, high = np.transpose([axis[[0, -1]] for axis in found.axes])

    def closest(start: Array) -> float:
        inside = np.clip(start, low, high)
        out = play_games(game, inside[None], duration, **options)
        return float(out.closest_distance[0])

    values = found.grid("closest_distance")
    local = values <= minimum_filter(values, size=3, mode="nearest")
    order = np.argsort(np.where(local, values, np.inf), axis=None)
    order = order[: min(_CANDIDATES, int(local.sum()))]
    cell = (high - low) / np.maximum(np.array(values.shape) - 1, 1)
    winner, worst = low, np.inf
    for index in zip(*np.unravel_index(order, values.shape), strict=True):
        center = np.array(
            [axis[i] for axis, i in zip(found.axes, index, strict=True)]
        )
        if values[index] < worst:
            winner, worst = center, float(values[index])
        if found.outcomes.captured.any():
            break
        simplex = center + np.vstack([np.zeros(3), np.diag(cell)])
        moved = minimize(
            closest,
            center,
            method="Nelder-Mead",
            bounds=list(zip(low, high, strict=True)),
            options={
                "initial_simplex": np.clip(simplex, low, high),
                "maxfev": _GAMES,
            },
        )
        if moved.fun < worst:
            winner, worst = np.clip(moved.x, low, high), float(moved.fun)
    r, a, psi = winner.tolist()
    return RelativeStart(r, a, psi), worst


def random_starts(game: Unicycles, count: int, *, seed: int = 0) -> Array:
    """Draw initial states r [m], a, psi [rad], uniformly. Shape (count, 3).

    Distances are 0.3 to 4 units, of the evader's speed over the
    smaller gain.
    """
    unit = game.evader_speed / min(game.pursuer_gain, game.evader_gain)
    rng = np.random.default_rng(seed)
    r = rng.uniform(NEAREST * unit, FARTHEST * unit, count)
    return np.column_stack([r, rng.uniform(-np.pi, np.pi, (count, 2))])


def find_basins(game: Unicycles, starts: Array, **options: Any) -> Outcomes:
    """Play games that are long enough to reach all stable circles.

    Args:
        game: Parameters of the game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        options: Options of :func:`.play_games`.
    """
    longest = _LONGEST / min(game.pursuer_gain, game.evader_gain)
    return play_games(
        game, starts, min(settling_time(game), longest), **options
    )
