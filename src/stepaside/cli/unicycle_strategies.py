"""One game of unicycles that play any two strategies."""

from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from .terminal import echo
from .value_labels import rows_of
from .value_types import print_table

if TYPE_CHECKING:
    from ..theory.unicycle.relative_coordinates import RelativeStart
    from ..theory.unicycle.unicycle_game import Game

# Options of an evader of the paper, by their parameter.
OF_EVADER = ("angle", "strategy", "law", "side_rule", "hysteresis")
EVERYWHERE = 1e9  # safety radius of a game that has no safety area, in [m]


def check_used(names: tuple[str, str]) -> None:
    """Refuse options of the paper's evader where no player plays it.

    Args:
        names: Strategies of pursuer and evader.

    Raises:
        UsageError: If such an option was given.
    """
    from ..strategies.registry import OF_EVASION

    if set(names) & set(OF_EVASION):
        return
    context = click.get_current_context()
    given = [
        f"--{name.replace('_', '-')}"
        for name in OF_EVADER
        if context.get_parameter_source(name) is ParameterSource.COMMANDLINE
    ]
    if given:
        raise click.UsageError(
            f"{', '.join(given)} must be left out beside a strategy other "
            f"than {' and '.join(OF_EVASION)}, which alone use it, got "
            f"--evader-strategy {names[1]}"
        )


def play_named(
    game: "Game",
    start: "RelativeStart",
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
