from .duel_settings import DuelSettings as DuelSettings
from .floor_games import StrategyTrack as StrategyTrack
from .floor_games import play_strategies as play_strategies
from .outcome import Outcome as Outcome
from .recorded_game import RecordedGame as RecordedGame
from .recorded_game import run_duel as run_duel
from .recorded_game import run_game as run_game
from .recorded_game import run_walk as run_walk
from .run import DuelRun as DuelRun
from .run import Run as Run
from .run import WalkRun as WalkRun

__all__ = [
    "DuelRun",
    "DuelSettings",
    "Outcome",
    "RecordedGame",
    "Run",
    "StrategyTrack",
    "WalkRun",
    "play_strategies",
    "run_duel",
    "run_game",
    "run_walk",
]
