"""From what a player knows to what it wants (paper, Sec. II)."""

from .deflected import Deflected
from .driven import Driven
from .evasion import Evasion, EvasionMemory
from .herding import HerdingPursuit
from .knowledge import STAND, Intent, Knowledge, Limits
from .lead import LeadPursuit
from .look_ahead import LookAhead
from .optimal import Optimal
from .optimal_pursuit import OptimalPursuit
from .pursuit import Pursuit
from .registry import STRATEGIES, load_strategy
from .steps import StepGame, StepOutcome, StepTrack, play_steps
from .strategy import Strategy
from .unicycles import StrategyRun, play_strategies
from .walk import Stand, Walk

__all__ = [
    "STAND",
    "STRATEGIES",
    "Deflected",
    "Driven",
    "Evasion",
    "EvasionMemory",
    "HerdingPursuit",
    "Intent",
    "Knowledge",
    "LeadPursuit",
    "Limits",
    "LookAhead",
    "Optimal",
    "OptimalPursuit",
    "Pursuit",
    "Stand",
    "StepGame",
    "StepOutcome",
    "StepTrack",
    "Strategy",
    "StrategyRun",
    "Walk",
    "load_strategy",
    "play_steps",
    "play_strategies",
]
