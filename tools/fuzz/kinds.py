"""All kinds of cases, in turn."""

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from random import Random

from click.testing import CliRunner

from stepaside.cli.main import main

from .calls import call_cases
from .case import Case
from .commands import BASES, combined_cases, command_cases
from .configurations import configuration_cases
from .folders import folder_cases
from .moments import moment_cases
from .places import place_cases
from .sockets import socket_cases

KINDS: dict[str, Callable[[Random, Path], Iterator[Case]]] = {
    "options": command_cases,
    "settings": lambda random, _: configuration_cases(random),
    "together": combined_cases,
    "folders": folder_cases,
    "calls": call_cases,
    "sockets": socket_cases,
    "moments": moment_cases,
    "places": place_cases,
}


def all_cases(
    seed: int, folder: Path, kinds: Collection[str]
) -> Iterator[Case]:
    """Yield cases of all kinds in turn, until none is left.

    Args:
        seed: Random seed of the order and of drawn values.
        folder: Folder for an intact run.
        kinds: Names in ``KINDS``.
    """
    run = folder / "run"
    make_run(run)
    warm_up()
    return _by_turns([KINDS[kind](Random(seed), run) for kind in kinds])


def _by_turns(left: list[Iterator[Case]]) -> Iterator[Case]:
    while left:
        for source in list(left):
            case = next(source, None)
            if case is None:
                left.remove(source)
            else:
                yield case


def make_run(folder: Path) -> None:
    """Run a short duel and write its folder."""
    from stepaside.games.duel import run_duel
    from stepaside.games.duel_settings import DuelSettings
    from stepaside.report.run_folder import write_run

    write_run(folder, run_duel(DuelSettings(duration=0.2)))


def warm_up() -> None:
    """Compile functions that are compiled on first use."""
    from stepaside.theory.unicycle import make_game, play_games
    from stepaside.theory.unicycle.basins import random_starts

    bound = "bound --grid 16 --refine 0 --games 0 --horizon 0.01 --json"
    CliRunner().invoke(main, bound.split())
    CliRunner().invoke(main, ["tournament", *BASES["tournament"]])
    game = make_game(1.0, 1.0, 0.5, 0.5, 1.5)
    play_games(game, random_starts(game, 2, seed=0), 1.0, step=0.1)
