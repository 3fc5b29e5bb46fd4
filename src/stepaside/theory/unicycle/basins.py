"""Which circle games end on, by playing them from random starts."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .all_circles import circles_of
from .circle_equations import Circle
from .kernel import Outcomes, play_games
from .unicycle_game import Game

Array = NDArray[np.float64]
NEAREST, FARTHEST = 0.3, 4.0  # of random starts, in units of the game
_SETTLE = 8.0  # time constants of the slowest stable circle that are waited
_LONGEST = 400.0  # at most, in units of the slower gain


@dataclass(frozen=True, slots=True)
class Basins:
    """Where games from random starts ended.

    Attributes:
        circles: Circles of the game, as ``circles_of`` gives them.
        shares: Share of the starts that settled on each of them, in [1].
        captured: Share that was captured, in [1].
        unsettled: Share that did neither within the duration, in [1].
        closest_distance: Mean closest approach, in [m].
        starts: Number of starts.
        duration: Length of each game, in [s].
    """

    circles: tuple[Circle, ...]
    shares: tuple[float, ...]
    captured: float
    unsettled: float
    closest_distance: float
    starts: int
    duration: float


def random_starts(
    game: Game,
    count: int,
    *,
    seed: int = 0,
    nearest: float | None = None,
    farthest: float | None = None,
) -> Array:
    """Draw starts with any headings.

    Args:
        game: Its unit of distance is the evader's speed over the smaller
            gain.
        count: Number of starts.
        seed: Of the random numbers.
        nearest: Least distance, in [m]; 0.3 units if None.
        farthest: Largest distance, in [m]; 4 units if None.

    Returns:
        Rows of r [m], a, psi [rad], all uniform. Shape (count, 3).
    """
    unit = game.evader.speed / min(game.pursuer.gain, game.evader.gain)
    low = NEAREST * unit if nearest is None else nearest
    high = FARTHEST * unit if farthest is None else farthest
    rng = np.random.default_rng(seed)
    r = rng.uniform(low, high, count)
    return np.column_stack([r, rng.uniform(-np.pi, np.pi, (count, 2))])


def find_basins(
    game: Game,
    starts: Array,
    *,
    capture_distance: float = 1e-6,
    duration: float | None = None,
    progress: Callable[[int], None] | None = None,
) -> Basins:
    """Play a game from many starts and count what they end on.

    Args:
        game: Parameters of the game.
        starts: Rows of r [m], a, psi [rad]. Shape (n, 3).
        capture_distance: Distance at which a game ends, in [m].
        duration: Length of each game, in [s]; if None, long enough for all
            stable circles of the game to be reached.
        progress: Called with numbers of games done.

    Returns:
        The shares.
    """
    circles = circles_of(game)
    until_all, step = lengths_of(game)
    duration = until_all if duration is None else duration
    out = play_games(
        game,
        starts,
        duration,
        step=step,
        capture_distance=capture_distance,
        progress=progress,
    )
    captured = float(out.captured.mean())
    return Basins(
        circles,
        shares_of(out, len(circles)),
        captured,
        float((out.circle < 0).mean()) - captured,
        float(out.closest_distance.mean()),
        len(starts),
        duration,
    )


def lengths_of(game: Game) -> tuple[float, float]:
    """How long games are played, and their steps, in [s].

    They are long enough for all stable circles of the game to be reached.
    """
    slow = min(game.pursuer.gain, game.evader.gain)
    fast = max(game.pursuer.gain, game.evader.gain)
    waits = [c.time_constant_s for c in circles_of(game) if c.stable]
    wait = 40.0 / slow + _SETTLE * max(waits, default=0.0)
    return min(wait, _LONGEST / slow), min(0.02 / slow, 0.1 / fast)


def shares_of(outcomes: Outcomes, count: int) -> tuple[float, ...]:
    """Share of games that settled on each of a number of circles."""
    numbers = np.bincount(outcomes.circle + 1, minlength=count + 1)[1:]
    return tuple((numbers / len(outcomes.circle)).tolist())
