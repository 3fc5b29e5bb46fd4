"""``stepaside run walk``: the walk of one humanoid, with pushes."""

from pathlib import Path

import click

from ..games.walk_settings import WalkSettings
from .options import folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings

NAMED = ("seed", "duration", "robot", "gait", "body", "bearing", "pushes")


@click.command("walk")
@takes_settings(NAMED, settings=WalkSettings)
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def walk(settings: WalkSettings, output: Path | None, as_json: bool) -> None:
    """Simulate the walk of one humanoid and measure it.

    Speed, turning, slip, tracking error and estimation error are measured
    after the first three seconds, in the frame of the support foot.
    """
    from ..games.recorded_game import run_walk

    folder = run_folder(output, as_json, None)
    run = play_with_bar(settings, run_walk)
    finish_run(run, folder, as_json)
