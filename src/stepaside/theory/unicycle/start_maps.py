"""Where games lead to from anywhere, and from where they go worst."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PlanError, check_positive, check_within
from .kernel import Outcomes, play_games
from .relative_coordinates import RelativeStart
from .unicycle_game import Game

Array = NDArray[np.float64]
_CANDIDATES = 8  # local minima of the grid that are refined
_FINE = 5  # points along each axis of a refined cell
_SHRINK = 0.6  # of a cell from one refinement to the next
_LEVELS = 14


@dataclass(frozen=True, slots=True)
class StartBox:
    """Starts that a map covers.

    Attributes:
        nearest: Least distance, in [m].
        farthest: Largest distance, in [m].
        aim: Largest pursuer error to either side, in [rad].
        facing: Largest bearing of the pursuer in the evader's frame to
            either side, in [rad]; the half field of view, say.
    """

    nearest: float
    farthest: float
    aim: float = pi
    facing: float = pi

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.nearest, "nearest", "m")
        check_positive(self.farthest, "farthest", "m")
        if self.farthest < self.nearest:
            raise PlanError(
                f"farthest must be >= nearest = {self.nearest} [m], "
                f"got {self.farthest}"
            )
        check_within(self.aim, 0.0, pi, "aim", "rad")
        check_within(self.facing, 0.0, pi, "facing", "rad")

    @property
    def low(self) -> Array:
        """Least (r, a, psi)."""
        return np.array([self.nearest, -self.aim, -self.facing])

    @property
    def high(self) -> Array:
        """Largest (r, a, psi)."""
        return np.array([self.farthest, self.aim, self.facing])


@dataclass(frozen=True, slots=True)
class StartMap:
    """Outcomes of games on a grid of starts.

    Attributes:
        distances: In [m]. Shape (n,).
        pursuer_errors: In [rad]. Shape (m,).
        bearings: In [rad]. Shape (l,).
        outcomes: Of all games, in C order over (n, m, l).
    """

    distances: Array
    pursuer_errors: Array
    bearings: Array
    outcomes: Outcomes

    @property
    def shape(self) -> tuple[int, int, int]:
        """Sizes of the grid."""
        return (
            len(self.distances),
            len(self.pursuer_errors),
            len(self.bearings),
        )

    def grid(self, name: str) -> Array:
        """One quantity of the outcomes over the grid. Shape (n, m, l)."""
        values: Array = getattr(self.outcomes, name).reshape(self.shape)
        return values


@dataclass(frozen=True, slots=True)
class WorstStart:
    """Start of the closest approach in a box.

    Attributes:
        start: The start.
        closest_distance: Its closest approach, in [m]; the capture distance
            if it is captured.
        captured: Whether it is.
        games: Number of games played to find it.
    """

    start: RelativeStart
    closest_distance: float
    captured: bool
    games: int


def map_starts(
    game: Game,
    box: StartBox,
    duration: float,
    *,
    shape: tuple[int, int, int] = (8, 37, 37),
    step: float = 0.01,
    capture_distance: float = 1e-6,
    progress: Callable[[int], None] | None = None,
) -> StartMap:
    """Play a game from every point of a grid over a box of starts.

    Args:
        game: Parameters of the game.
        box: Starts to cover.
        duration: Length of each game, in [s].
        shape: Points along distance, pursuer error and bearing.
        step: Step of the integration, in [s].
        capture_distance: Distance at which a game ends, in [m].
        progress: Called with numbers of games done.
    """
    bounds = zip(box.low, box.high, shape, strict=True)
    axes = [np.linspace(low, high, count) for low, high, count in bounds]
    starts = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    outcomes = play_games(
        game,
        starts.reshape(-1, 3),
        duration,
        step=step,
        capture_distance=capture_distance,
        progress=progress,
    )
    return StartMap(axes[0], axes[1], axes[2], outcomes)


Lowest = Callable[[Array], Array]
"""Closest approaches of games from starts of shape (n, 3); shape (n,)."""


def find_worst_start(
    game: Game,
    start_map: StartMap,
    box: StartBox,
    duration: float,
    *,
    step: float = 0.01,
    capture_distance: float = 1e-6,
) -> WorstStart:
    """Refine the local minima of a map down to the worst start.

    Around each of the lowest local minima of the grid a small grid is
    played; it moves to its best point and shrinks, and the winner is
    polished by Nelder and Mead's simplex.

    Args:
        game: Parameters of the game.
        start_map: Map over the same box.
        box: Starts to cover.
        duration: Length of each game, in [s].
        step: Step of the integration, in [s].
        capture_distance: Distance at which a game ends, in [m].

    Returns:
        The worst start found.
    """
    played = start_map.outcomes.closest_distance.size

    def lowest(starts: Array) -> Array:
        nonlocal played
        played += len(starts)
        return play_games(
            game,
            np.clip(starts, box.low, box.high),
            duration,
            step=step,
            capture_distance=capture_distance,
        ).closest_distance

    centers, best = _local_minima(start_map)
    cell = (box.high - box.low) / np.maximum(np.array(start_map.shape) - 1, 1)
    for _ in range(_LEVELS):
        if best.min() <= capture_distance:
            break
        centers, best = _refine(lowest, box, centers, best, cell)
        cell = cell * _SHRINK
    winner, worst = centers[best.argmin()], float(best.min())
    if worst > capture_distance:
        winner, worst = _polish(lowest, box, winner, worst, cell)
    captured = worst <= capture_distance * (1.0 + 1e-9)
    r, a, psi = winner.tolist()
    return WorstStart(RelativeStart(r, a, psi), worst, captured, played)


def _local_minima(start_map: StartMap) -> tuple[Array, Array]:
    """Lowest local minima of a map: starts (n, 3) and distances (n,)."""
    from scipy.ndimage import minimum_filter

    values = start_map.grid("closest_distance")
    local = values <= minimum_filter(values, size=3, mode="nearest")
    order = np.argsort(np.where(local, values, np.inf), axis=None)
    order = order[: min(_CANDIDATES, int(local.sum()))]
    index = np.unravel_index(order, values.shape)
    axes = (start_map.distances, start_map.pursuer_errors, start_map.bearings)
    starts = [axis[i] for axis, i in zip(axes, index, strict=True)]
    return np.stack(starts, axis=-1), values.ravel()[order]


def _refine(
    lowest: Lowest, box: StartBox, centers: Array, best: Array, cell: Array
) -> tuple[Array, Array]:
    """Move each centre to the best point of a small grid around it."""
    spots = np.linspace(-1.0, 1.0, _FINE)
    offsets = np.stack(np.meshgrid(spots, spots, spots), -1).reshape(-1, 3)
    tried = np.clip(centers[:, None] + cell * offsets, box.low, box.high)
    found = lowest(tried.reshape(-1, 3)).reshape(len(centers), -1)
    pick, least = found.argmin(axis=1), found.min(axis=1)
    better = (least < best)[:, None]
    moved = np.where(better, tried[np.arange(len(centers)), pick], centers)
    return moved, np.minimum(best, least)


def _polish(
    lowest: Lowest, box: StartBox, winner: Array, worst: float, cell: Array
) -> tuple[Array, float]:
    """Better a start by a simplex, if that betters it."""
    from scipy.optimize import minimize

    simplex = winner + np.vstack([np.zeros(3), 2.0 * np.diag(cell)])
    result = minimize(
        lambda start: float(lowest(np.array([start]))[0]),
        winner,
        method="Nelder-Mead",
        bounds=list(zip(box.low, box.high, strict=True)),
        options={
            "initial_simplex": np.clip(simplex, box.low, box.high),
            "maxfev": 120,
        },
    )
    if result.fun < worst:
        return np.clip(result.x, box.low, box.high), float(result.fun)
    return winner, worst
