"""``stepaside run FILE``: a game of any number of players."""

from pathlib import Path

import click

from .options import file_argument, folder_option, json_option
from .run_output import finish_run, play_with_bar, run_folder
from .settings import changes_of, lists_option, set_option, set_pair
from .settings_text import commented
from .terminal import write_result


@click.command("game")
@file_argument("file")
@click.option("--seed", metavar="NUMBER", help="Random seed.")
@click.option("--duration", metavar="NUMBER", help="Simulated time [s].")
@click.option("--level", metavar="TEXT", help="Level of simulation.")
@lists_option
@set_option
@folder_option()
@json_option
def game(
    file: Path,
    sets: tuple[str, ...],
    lists: bool,
    output: Path | None,
    as_json: bool,
    **named: str | None,
) -> None:
    """Play the game of the players that FILE lists.

    FILE is TOML with a table [[players]] for each player: a robot, its
    template unicycle, a person, or a recorded player (docs/games.md). Prints
    the closest approach of each pair, and writes a run folder, which
    `stepaside show` shows.
    """
    from ..games.recorded_game import run_game
    from ..games.settings_reader import (
        entries_of_game,
        load_game,
        nested,
        read_game,
    )

    texts = [(name, text) for name, text in named.items() if text]
    texts += map(set_pair, sets)
    settings = load_game(file)
    changes = changes_of(texts, entries_of_game(settings))
    settings = read_game(nested(changes), base=settings)
    if lists:
        write_result(commented(settings))
        return
    folder = run_folder(output, as_json, f"game-seed{settings.seed}")
    run = play_with_bar(settings, run_game)
    finish_run(run, folder, as_json)
