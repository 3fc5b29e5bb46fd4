"""``stepaside duel``: a duel of two humanoids in physics."""

from pathlib import Path
from typing import Any

import click

from ..games.game_settings import GameSettings
from ..games.game_settings import duel as make_duel
from .options import folder_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings
from .terminal import echo, json_option

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
    from ..games.forecast import forecast
    from ..games.game import play
    from ..games.recorded_game import RecordedGame

    def play_warned(settings: GameSettings, report: Any) -> Any:
        game = RecordedGame(settings)  # what it refuses is said first
        end = forecast(game.settings)
        if end.expected in ("contact", "no circle"):
            echo(f"stepaside: expected outcome: {end.words}", err=True)
        play(game, report=report)
        return game.run()

    folder = run_folder(output, as_json, f"duel-seed{settings.seed}")
    run = play_with_bar(settings, play_warned)
    finish_run(run, folder, as_json)
