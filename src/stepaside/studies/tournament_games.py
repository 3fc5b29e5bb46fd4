"""Games of a tournament without physics."""

from dataclasses import asdict

from ..arena import Room
from ..strategies import Strategy
from ..strategies.strategy_game import StepGame, StrategyTrack, play_strategies
from .tournament_settings import TournamentSettings

FEEDBACK = 8  # decisions per step at level "unicycle"


def play_game(
    settings: TournamentSettings,
    evader: Strategy,
    pursuer: Strategy,
    seed: int,
    speed_ratio: float = 1.0,
) -> tuple[Room, StrategyTrack]:
    """Play one game at level "steps" or "unicycle"; return its track.

    Args:
        settings: Settings of the tournament.
        evader: Strategy of the evader.
        pursuer: Strategy of the pursuer.
        seed: Seed of the room.
        speed_ratio: Speed of the pursuer over that of the evader.
    """
    room, starts = settings.arena(seed)
    unicycles = settings.level == "unicycle"
    game = StepGame(
        **asdict(settings.game)
        | {
            "decisions": FEEDBACK if unicycles else 1,
            "pursuer_speed_ratio": speed_ratio,
        }
    )
    return room, play_strategies(pursuer, evader, starts, room=room, game=game)
