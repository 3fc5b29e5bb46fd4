"""Campaign of evaders against pursuers: one record per game."""

from collections.abc import Sequence
from functools import partial

from ..strategies.table_cache import pursuit_bound
from .case_grid import CaseGrid
from .study import Study
from .tabulation import Record
from .tournament_record import CELLS, Pairing, play_record
from .tournament_settings import TournamentSettings

Game = tuple[Pairing, int]
"""Names of evader and pursuer, and the seed of a game."""


def tournament_study(
    settings: TournamentSettings,
    pairings: Sequence[Pairing],
    seeds: Sequence[int],
) -> Study[Game]:
    """Return the study of every pairing with every seed.

    Args:
        settings: Settings of every game.
        pairings: Evader and pursuer of each pairing.
        seeds: Seeds of the games of each pairing.
    """
    own = settings.fingerprint()
    pursuit_bound(CELLS)  # solved once here, not in each worker

    def key_of(game: Game) -> str:
        pairing, seed = game
        return f"{own}/{'/'.join(pairing)}/{seed}"

    return Study(
        "tournament",
        CaseGrid(pairings, seeds),
        partial(_play, settings),
        key_of,
    )


def _play(settings: TournamentSettings, game: Game) -> Record:
    return play_record(settings, *game)
