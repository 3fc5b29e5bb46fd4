"""Game of unicycles with any two strategies."""

from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from .tables import print_table, table_rows
from .terminal import echo

if TYPE_CHECKING:
    from ..theory.unicycle.relative_coordinates import RelativeStart
    from ..theory.unicycle.unicycle_game import Game

# Parameters of options that only the paper's evader uses.
OF_EVADER = ("angle", "strategy", "law", "side_rule", "hysteresis")


def check_used(names: tuple[str, str]) -> None:
    """Refuse options of the paper's evader if no player uses it.

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
            f"{', '.join(given)} requires the strategy "
            f"{' or '.join(OF_EVASION)}, got --evader-strategy {names[1]}"
        )


def play_named_game(
    game: "Game",
    start: "RelativeStart",
    names: tuple[str, str],
    times: tuple[float, float],
    capture: float,
) -> dict[str, Any]:
    """Simulate a game and return its results for JSON.

    Args:
        game: Speeds, gains, and parameters of the paper's evader.
        start: Initial relative pose.
        names: Strategies of pursuer and evader.
        times: Duration and decision period, in [s].
        capture: Capture distance, in [m]; ends the game.
    """
    import numpy as np

    from ..games.floor_games import play_unicycles

    run = play_unicycles(game, start, names, times, capture)
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


def print_named_game(result: dict[str, Any]) -> None:
    """Print the results."""
    names = ("closest_distance_m", "distance_m", "floor_used_evader_m")
    rows = table_rows(result, (*names, "captured", "end_time_s"))
    echo(f"{result['evader_strategy']} against {result['pursuer_strategy']}")
    print_table(rows)
