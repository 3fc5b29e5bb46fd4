"""One game of unicycles that play any two strategies."""

from typing import TYPE_CHECKING, Any

from .labels import rows_of
from .options import print_table
from .terminal import echo

if TYPE_CHECKING:
    from ..unicycle.laws import Game
    from ..unicycle.relative import Start

EVERYWHERE = 1e9  # safety radius of a game that has no safety area, in [m]


def play_named(
    game: "Game",
    start: "Start",
    names: tuple[str, str],
    times: tuple[float, float],
    capture: float,
) -> dict[str, Any]:
    """Play a game and measure it.

    Args:
        game: Speeds and gains, and how an evader of the paper evades.
        start: Where they stand to each other.
        names: Strategies of pursuer and evader.
        times: Duration and time between two decisions, in [s].
        capture: Distance at which the game ends, in [m].
    """
    import numpy as np

    from ..strategies import Evasion, load_strategy, play_strategies

    evasion = Evasion(
        game.angle,
        game.saturated,
        safety_radius=EVERYWHERE,
        side_hysteresis=game.hysteresis,
    )
    pursuer, evader = (load_strategy(name, evasion) for name in names)
    run = play_strategies(
        pursuer,
        evader,
        start,
        bodies=(game.pursuer, game.evader),
        duration=times[0],
        period=times[1],
        capture_distance=capture,
    )
    floor = [
        float(np.hypot(*(path - path[0])[:, :2].T).max())
        for path in (run.pursuer, run.evader)
    ]
    return {
        "pursuer_strategy": names[0],
        "evader_strategy": names[1],
        "captured": run.captured,
        "end_time_s": float(run.times[-1]),
        "closest_distance_m": run.closest_distance,
        "distance_m": float(run.distances[-1]),
        "floor_used_pursuer_m": floor[0],
        "floor_used_evader_m": floor[1],
    }


def print_named(result: dict[str, Any]) -> None:
    """Print what was measured."""
    names = ("closest_distance_m", "distance_m", "floor_used_evader_m")
    rows = rows_of(result, (*names, "captured", "end_time_s"))
    echo(f"{result['evader_strategy']} against {result['pursuer_strategy']}")
    print_table(rows)
