from .game import Outcome as Outcome
from .game_settings import GameSettings as GameSettings
from .game_settings import duel as duel
from .game_settings import walk as walk
from .player_settings import PlayerSettings as PlayerSettings
from .recorded_game import RecordedGame as RecordedGame
from .recorded_game import run_game as run_game
from .run import Run as Run

__all__ = [
    "GameSettings",
    "Outcome",
    "PlayerSettings",
    "RecordedGame",
    "Run",
    "duel",
    "run_game",
    "walk",
]
