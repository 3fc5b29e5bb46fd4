"""From what a player knows to what it wants (paper, Sec. II)."""

from .driven import Driven
from .evasion import Evasion, EvasionMemory
from .knowledge import STAND, Intent, Knowledge, Limits
from .pursuit import Pursuit
from .registry import STRATEGIES, load_strategy
from .strategy import Strategy
from .unicycles import StrategyRun, play_strategies
from .walk import Stand, Walk

__all__ = [
    "STAND",
    "STRATEGIES",
    "Driven",
    "Evasion",
    "EvasionMemory",
    "Intent",
    "Knowledge",
    "Limits",
    "Pursuit",
    "Stand",
    "Strategy",
    "StrategyRun",
    "Walk",
    "load_strategy",
    "play_strategies",
]
