"""Maps of games: over initial states, by final circle, over ratios."""

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PlanError, check_positive, check_within
from .circles import Circle, circles_of
from .simulation import Outcomes, play_games
from .unicycle_game import Game, RelativeStart

Array = NDArray[np.float64]
_CANDIDATES = 4  # local minima of the grid that are refined
_GAMES = 150  # of the refinement of one of them
NEAREST, FARTHEST = 0.3, 4.0  # initial distances, in units of the game
_SETTLE = 8.0  # simulated time constants of the slowest stable circle
_LONGEST = 400.0  # longest game, in units of one over the smaller gain


@dataclass(frozen=True, slots=True)
class StartBox:
    """Box of initial states."""

    nearest: float  # least distance, in [m]
    farthest: float  # largest distance, in [m]
    aim: float = pi  # largest magnitude of the pursuer's error, in [rad]
    # Largest magnitude of the bearing of the pursuer in the evader's frame,
    # in [rad]; for example half the field of view.
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
    """Outcomes of games over a grid of initial states."""

    distances: Array  # distances, in [m]. Shape (n,)
    pursuer_errors: Array  # errors of the pursuer, in [rad]. Shape (m,)
    bearings: Array  # bearings of the pursuer, in [rad]. Shape (l,)
    outcomes: Outcomes  # outcomes of all games, in C order over (n, m, l)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape (n, m, l) of the grid."""
        return (
            len(self.distances),
            len(self.pursuer_errors),
            len(self.bearings),
        )

    def grid(self, name: str) -> Array:
        """Return a field of the outcomes over the grid. Shape (n, m, l)."""
        values: Array = getattr(self.outcomes, name).reshape(self.shape)
        return values


@dataclass(frozen=True, slots=True)
class WorstStart:
    """Initial state with the closest approach in a box, in [m].

    That is the capture distance if the evader is captured. ``games``
    counts those of the search.
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
    **options: Any,
) -> StartMap:
    """Play a game from every point of a grid of initial states.

    Args:
        game: Parameters of the game.
        box: Box of initial states.
        duration: Duration of each game, in [s].
        shape: Points along distance, pursuer error and bearing.
        options: Options of :func:`.play_games`.
    """
    bounds = zip(box.low, box.high, shape, strict=True)
    axes = [np.linspace(low, high, count) for low, high, count in bounds]
    starts = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    outcomes = play_games(game, starts.reshape(-1, 3), duration, **options)
    return StartMap(axes[0], axes[1], axes[2], outcomes)


def find_worst_start(
    game: Game,
    start_map: StartMap,
    box: StartBox,
    duration: float,
    *,
    capture_distance: float = 1e-6,
    **options: Any,
) -> WorstStart:
    """Search the worst initial state from the local minima of a map.

    Each is moved by the Nelder-Mead simplex method; the best result
    counts. Arguments are those of :func:`map_starts`.
    """
    from scipy.optimize import minimize

    played = start_map.outcomes.closest_distance.size
    options["capture_distance"] = capture_distance

    def closest(start: Array) -> float:
        nonlocal played
        played += 1
        inside = np.clip(start, box.low, box.high)
        out = play_games(game, inside[None], duration, **options)
        return float(out.closest_distance[0])

    cell = (box.high - box.low) / np.maximum(np.array(start_map.shape) - 1, 1)
    centers, best = _local_minima(start_map)
    winner, worst = centers[0], float(best[0])
    for center in centers:
        if worst <= capture_distance:
            break
        simplex = center + np.vstack([np.zeros(3), np.diag(cell)])
        found = minimize(
            closest,
            center,
            method="Nelder-Mead",
            bounds=list(zip(box.low, box.high, strict=True)),
            options={
                "initial_simplex": np.clip(simplex, box.low, box.high),
                "maxfev": _GAMES,
            },
        )
        if found.fun < worst:
            winner = np.clip(found.x, box.low, box.high)
            worst = float(found.fun)
    captured = worst <= capture_distance * (1.0 + 1e-9)
    r, a, psi = winner.tolist()
    return WorstStart(RelativeStart(r, a, psi), worst, captured, played)


def _local_minima(start_map: StartMap) -> tuple[Array, Array]:
    """Return the lowest local minima: states (n, 3) and distances (n,)."""
    from scipy.ndimage import minimum_filter

    values = start_map.grid("closest_distance")
    local = values <= minimum_filter(values, size=3, mode="nearest")
    order = np.argsort(np.where(local, values, np.inf), axis=None)
    order = order[: min(_CANDIDATES, int(local.sum()))]
    index = np.unravel_index(order, values.shape)
    axes = (start_map.distances, start_map.pursuer_errors, start_map.bearings)
    starts = [axis[i] for axis, i in zip(axes, index, strict=True)]
    return np.stack(starts, axis=-1), values.ravel()[order]


@dataclass(frozen=True, slots=True)
class Basins:
    """Final circles of games from many initial states."""

    # Circles of the game, in the order of circles_of.
    circles: tuple[Circle, ...]
    # Fraction of the games that settled on each circle, in [1].
    shares: tuple[float, ...]
    captured: float  # fraction of the games that ended by capture, in [1]
    unsettled: float  # fraction with neither within the duration, in [1]
    closest_distance: float  # mean closest approach, in [m]
    starts: int  # number of initial states
    duration: float  # duration of each game, in [s]


def random_starts(
    game: Game,
    count: int,
    *,
    seed: int = 0,
) -> Array:
    """Draw initial states r [m], a, psi [rad], uniformly. Shape (count, 3).

    Distances are 0.3 to 4 units, of the evader's speed over the
    smaller gain.
    """
    unit = game.evader.speed / min(game.pursuer.gain, game.evader.gain)
    rng = np.random.default_rng(seed)
    r = rng.uniform(NEAREST * unit, FARTHEST * unit, count)
    return np.column_stack([r, rng.uniform(-np.pi, np.pi, (count, 2))])


def find_basins(game: Game, starts: Array, **options: Any) -> Basins:
    """Play a game from many initial states and classify the outcomes.

    Games are long enough to reach all stable circles.

    Args:
        game: Parameters of the game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        options: Further options of :func:`.play_games`.
    """
    circles = circles_of(game)
    duration, step = duration_and_step(game)
    out = play_games(game, starts, duration, step=step, **options)
    captured = float(out.captured.mean())
    return Basins(
        circles,
        settled_fractions(out, len(circles)),
        captured,
        float((out.circle < 0).mean()) - captured,
        float(out.closest_distance.mean()),
        len(starts),
        duration,
    )


def duration_and_step(game: Game) -> tuple[float, float]:
    """Return duration and time step of games that reach stable circles."""
    slow, fast = sorted((game.pursuer.gain, game.evader.gain))
    constants = [c.time_constant_s for c in circles_of(game) if c.stable]
    duration = 40.0 / slow + _SETTLE * max(constants, default=0.0)
    return min(duration, _LONGEST / slow), min(0.02 / slow, 0.1 / fast)


def settled_fractions(outcomes: Outcomes, count: int) -> tuple[float, ...]:
    """Return the fraction of games that settled on each of the circles."""
    numbers = np.bincount(outcomes.circle + 1, minlength=count + 1)[1:]
    return tuple((numbers / len(outcomes.circle)).tolist())
