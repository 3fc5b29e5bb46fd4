"""The MuJoCo world of two robots, and the game played in it."""

from .duel import DuelResult, Outcome, run_duel
from .settings import DuelSettings

__all__ = ["DuelResult", "DuelSettings", "Outcome", "run_duel"]
