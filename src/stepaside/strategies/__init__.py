"""Strategies: from knowledge and memory to an intent (paper, Sec. II)."""

from .constant_walk import StandStill, Walk
from .dash_evasion import DashEvasion
from .deflected_evasion import DeflectedEvasion
from .evasion import Evasion, EvasionMemory
from .herding import HerdingPursuit
from .knowledge import STAND, Intent, Knowledge, Limits
from .lead_pursuit import LeadPursuit
from .learned import LearnedStrategy
from .look_ahead import LookAhead
from .optimal_evasion import OptimalEvasion
from .optimal_pursuit import OptimalPursuit
from .pursuit import Pursuit
from .registry import STRATEGIES, load_strategy
from .robust_evasion import RobustEvasion
from .strategy import Strategy
from .strategy_game import (
    StepGame,
    StrategyOutcome,
    StrategyTrack,
    UnicycleMatch,
    play_strategies,
)
from .teleoperation import TeleoperatedPursuit

__all__ = [
    "STAND",
    "STRATEGIES",
    "DashEvasion",
    "DeflectedEvasion",
    "TeleoperatedPursuit",
    "Evasion",
    "EvasionMemory",
    "HerdingPursuit",
    "Intent",
    "Knowledge",
    "LeadPursuit",
    "LearnedStrategy",
    "Limits",
    "LookAhead",
    "OptimalEvasion",
    "OptimalPursuit",
    "Pursuit",
    "RobustEvasion",
    "StandStill",
    "StepGame",
    "Strategy",
    "StrategyOutcome",
    "StrategyTrack",
    "UnicycleMatch",
    "Walk",
    "load_strategy",
    "play_strategies",
]
