"""Short games of ``tests/data/games.toml``, each played once by a worker."""

import tomllib
from functools import cache

from stepaside.games import run_game
from stepaside.games.game_settings import read_game
from stepaside.games.run import Run
from stored_values import DATA

GAMES = tomllib.loads((DATA / "games.toml").read_text())


@cache
def run_of(name: str) -> Run:
    """Return the run of a game."""
    return run_game(read_game(GAMES[name], name))
