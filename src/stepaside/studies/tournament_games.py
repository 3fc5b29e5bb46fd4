"""Games of a tournament without physics."""

from dataclasses import replace

from ..arena import Room
from ..games.floor_games import StrategyTrack, play_strategies
from ..strategies import Strategy
from .tournament_settings import TournamentSettings

FEEDBACK = 8  # decisions per step at level "unicycle"


def play_game(
    settings: TournamentSettings,
    evader: Strategy,
    pursuer: Strategy,
    seed: int,
) -> tuple[Room, StrategyTrack]:
    """Play one game at level "steps" or "unicycle"; return its track.

    Args:
        settings: Settings of the tournament.
        evader: Strategy of the evader.
        pursuer: Strategy of the pursuer.
        seed: Seed of the room.
    """
    room, starts = settings.arena(seed)
    unicycles = settings.level == "unicycle"
    game = replace(settings.game, decisions=FEEDBACK if unicycles else 1)
    return room, play_strategies(pursuer, evader, starts, room=room, game=game)
