"""Basins of attraction of the limit circles, by random sampling."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .batch import Outcomes, play_games
from .circles import Circle, circles_of
from .unicycle_game import Game

Array = NDArray[np.float64]
NEAREST, FARTHEST = 0.3, 4.0  # initial distances, in units of the game
_SETTLE = 8.0  # simulated time constants of the slowest stable circle
_LONGEST = 400.0  # longest game, in units of one over the smaller gain


@dataclass(frozen=True, slots=True)
class Basins:
    """Final circles of games from many initial states.

    Attributes:
        circles: Circles of the game, in the order of ``circles_of``.
        shares: Fraction of the games that settled on each circle, in [1].
        captured: Fraction of the games that ended by capture, in [1].
        unsettled: Fraction with neither within the duration, in [1].
        closest_distance: Mean closest approach, in [m].
        starts: Number of initial states.
        duration: Duration of each game, in [s].
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
        options: Further options of :func:`.batch.play_games`.
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
