from .duel import Duel as Duel
from .duel import run_duel as run_duel
from .duel_settings import DuelSettings as DuelSettings
from .floor_games import StrategyTrack as StrategyTrack
from .floor_games import play_strategies as play_strategies
from .outcome import Outcome as Outcome
from .run import DuelRun as DuelRun
from .run import Run as Run
from .run import WalkRun as WalkRun

__all__ = [
    "Duel",
    "DuelRun",
    "DuelSettings",
    "Outcome",
    "Run",
    "StrategyTrack",
    "WalkRun",
    "play_strategies",
    "run_duel",
]
