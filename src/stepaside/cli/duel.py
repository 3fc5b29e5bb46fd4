"""``stepaside duel``: a duel of two humanoids in physics."""

from pathlib import Path

import click

from ..games.duel_settings import DuelSettings
from .options import folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings
from .terminal import echo

NAMED = (
    *("seed", "duration", "robot", "gait", "body"),
    *("sensing", "room.plan", "start.distance", "evader_strategy", "pursuer"),
)
"""Settings of a duel with an option of their own."""


@click.command("duel")
@takes_settings(NAMED, settings=DuelSettings)
@folder_option()
@json_option
def duel(settings: DuelSettings, output: Path | None, as_json: bool) -> None:
    """Simulate a duel of two humanoids in physics.

    Prints values measured over the last third of the duel beside those of
    theory, and writes a run folder with the configuration, the trajectories
    and a figure.
    """
    from ..games.recorded_game import run_duel

    folder = run_folder(output, as_json, f"duel-seed{settings.seed}")
    _warn_of_expected_end(settings)
    run = play_with_bar(settings, run_duel)
    finish_run(run, folder, as_json)


def _warn_of_expected_end(settings: DuelSettings) -> None:
    """Print a warning if two robots are not expected to reach a circle."""
    from ..games.forecast import CONTACT, NO_CIRCLE, forecast
    from ..games.initial_poses import with_initial_poses

    end = forecast(with_initial_poses(settings))
    if end.expected in (CONTACT, NO_CIRCLE):
        echo(f"stepaside: expected outcome: {end.words}", err=True)
