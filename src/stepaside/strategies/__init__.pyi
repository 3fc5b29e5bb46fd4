from .dash_evasion import DashEvasion as DashEvasion
from .evasion import Evasion as Evasion
from .evasion import EvasionMemory as EvasionMemory
from .knowledge import STAND as STAND
from .knowledge import Intent as Intent
from .knowledge import Knowledge as Knowledge
from .knowledge import Limits as Limits
from .learned import LearnedStrategy as LearnedStrategy
from .look_ahead import LookAhead as LookAhead
from .pursuit import Pursuit as Pursuit
from .registry import STRATEGIES as STRATEGIES
from .registry import load_strategy as load_strategy
from .robust_evasion import RobustEvasion as RobustEvasion
from .shield import ShieldedStrategy as ShieldedStrategy
from .shield_settings import ShieldSettings as ShieldSettings
from .strategy import StandStill as StandStill
from .strategy import Strategy as Strategy
from .strategy import Walk as Walk
from .team_strategies import AssignedPursuit as AssignedPursuit
from .team_strategies import CyclicPursuit as CyclicPursuit
from .team_strategies import GoalWalk as GoalWalk
from .team_strategies import Pincer as Pincer
from .team_strategies import TeamEvasion as TeamEvasion

__all__ = [
    "AssignedPursuit",
    "CyclicPursuit",
    "DashEvasion",
    "Evasion",
    "EvasionMemory",
    "GoalWalk",
    "Intent",
    "Knowledge",
    "LearnedStrategy",
    "Limits",
    "LookAhead",
    "Pincer",
    "Pursuit",
    "RobustEvasion",
    "STAND",
    "STRATEGIES",
    "ShieldSettings",
    "ShieldedStrategy",
    "StandStill",
    "Strategy",
    "TeamEvasion",
    "Walk",
    "load_strategy",
]
