from .duel_settings import DuelSettings as DuelSettings
from .floor_games import StrategyTrack as StrategyTrack
from .floor_games import play_strategies as play_strategies
from .outcome import Outcome as Outcome
from .recorded_game import RecordedGame as RecordedGame
from .recorded_game import run_duel as run_duel
from .recorded_game import run_game as run_game
from .recorded_game import run_walk as run_walk
from .run import Run as Run

__all__ = [
    "Run",
    "DuelSettings",
    "Outcome",
    "RecordedGame",
    "StrategyTrack",
    "play_strategies",
    "run_duel",
    "run_game",
    "run_walk",
]
