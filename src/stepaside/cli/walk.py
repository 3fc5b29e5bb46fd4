"""``stepaside run walk``: the walk of one humanoid, with pushes."""

from pathlib import Path

import click

from ..games.game_settings import GameSettings
from ..games.game_settings import walk as make_walk
from .options import folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import takes_settings

NAMED = ("seed", "duration", "robot", "gait", "body", "pushes")


@click.command("walk")
@takes_settings(NAMED, settings=make_walk())
@click.option(
    "--bearing",
    metavar="ANGLE",
    help="Desired heading in the frame of the support foot, like 10deg; "
    "straight ahead by default.",
)
@click.option("--backward", is_flag=True, help="Walk backward.")
@folder_option(help="Run folder; the run is not saved by default.")
@json_option
def walk(
    settings: GameSettings,
    bearing: str | None,
    backward: bool,
    output: Path | None,
    as_json: bool,
) -> None:
    """Simulate the walk of one humanoid and measure it.

    Speed, turning, slip, tracking error and estimation error are measured
    after the first three seconds, in the frame of the support foot.
    """
    from ..games.recorded_game import run_game

    if bearing or backward:
        way = f"walk{'-backward' * backward}(bearing={bearing or 0})"
        settings = settings.changed(walker={"strategy": way})
    folder = run_folder(output, as_json, None)
    run = play_with_bar(settings, run_game)
    finish_run(run, folder, as_json)
