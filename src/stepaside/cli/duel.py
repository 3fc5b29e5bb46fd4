"""``stepaside duel``: a duel of two humanoids in physics."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..games.game_settings import GameSettings
from ..games.game_settings import duel as make_duel
from .options import folder_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings
from .terminal import echo, json_option

if TYPE_CHECKING:
    from ..games.game import Progress
    from ..games.run import Run

NAMED = (
    *("seed", "duration", "robot", "gait", "body"),
    *("senses", "room", "start.distance", "evader.strategy", "pursuer.body"),
)
"""Settings of a duel with an option of their own."""


@click.command("duel")
@takes_settings(NAMED, make_duel())
@folder_option()
@json_option
def duel(settings: GameSettings, output: Path | None, as_json: bool) -> None:
    """Simulate a duel of two humanoids in physics.

    Prints values measured over the last third of the duel beside those of
    theory, and writes a run folder with the configuration, the trajectories
    and a figure.
    """
    folder = run_folder(output, as_json, f"duel-seed{settings.seed}")
    run = play_with_bar(settings, _play)
    finish_run(run, folder, as_json)


def _play(
    settings: GameSettings, report: "Callable[[Progress], None]"
) -> "Run":
    """Play a duel; what it refuses is said before the expected end."""
    from ..games.game import play
    from ..games.recorded_game import RecordedGame

    game = RecordedGame(settings)
    _warn_of_expected_end(game.settings)
    play(game, report=report)
    return game.run()


def _warn_of_expected_end(settings: GameSettings) -> None:
    """Print a warning if two robots are not expected to reach a circle."""
    from ..games.forecast import forecast

    end = forecast(settings)
    if end.expected in ("contact", "no circle"):
        echo(f"stepaside: expected outcome: {end.words}", err=True)
