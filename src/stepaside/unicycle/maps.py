"""Where games lead to from anywhere, and from where they go worst."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from ..errors import PlanError, check_positive, check_within
from .kernel import Outcomes, play_games
from .laws import Game
from .relative import Start

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

    start: Start
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
    from scipy.ndimage import minimum_filter
    from scipy.optimize import minimize

    played = start_map.outcomes.closest_distance.size
    low, high = box.low, box.high

    def lowest(starts: Array) -> Array:
        nonlocal played
        played += len(starts)
        return play_games(
            game,
            np.clip(starts, low, high),
            duration,
            step=step,
            capture_distance=capture_distance,
        ).closest_distance

    values = start_map.grid("closest_distance")
    local = values <= minimum_filter(values, size=3, mode="nearest")
    order = np.argsort(np.where(local, values, np.inf), axis=None)
    order = order[: min(_CANDIDATES, int(local.sum()))]
    index = np.stack(np.unravel_index(order, values.shape), axis=-1)
    axes = (start_map.distances, start_map.pursuer_errors, start_map.bearings)
    centers = np.stack([axes[i][index[:, i]] for i in range(3)], axis=-1)
    best = values.ravel()[order]
    counts = np.maximum(np.array(values.shape) - 1, 1)
    cell = (high - low) / counts
    spots = np.linspace(-1.0, 1.0, _FINE)
    offsets = np.stack(np.meshgrid(spots, spots, spots), -1).reshape(-1, 3)
    for _ in range(_LEVELS):
        if best.min() <= capture_distance:
            break
        tried = np.clip(centers[:, None] + cell * offsets, low, high)
        found = lowest(tried.reshape(-1, 3)).reshape(len(centers), -1)
        pick = found.argmin(axis=1)
        better = found.min(axis=1) < best
        rows = np.arange(len(centers))
        centers = np.where(better[:, None], tried[rows, pick], centers)
        best = np.minimum(best, found.min(axis=1))
        cell = cell * _SHRINK
    winner, worst = centers[best.argmin()], float(best.min())
    if worst > capture_distance:
        simplex = winner + np.vstack([np.zeros(3), 2.0 * np.diag(cell)])
        result = minimize(
            lambda s: float(lowest(np.array([s]))[0]),
            winner,
            method="Nelder-Mead",
            bounds=list(zip(low, high, strict=True)),
            options={
                "initial_simplex": np.clip(simplex, low, high),
                "maxfev": 120,
            },
        )
        if result.fun < worst:
            winner, worst = np.clip(result.x, low, high), float(result.fun)
    captured = worst <= capture_distance * (1.0 + 1e-9)
    r, a, psi = winner.tolist()
    return WorstStart(Start(r, a, psi), worst, captured, played)
