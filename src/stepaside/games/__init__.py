"""The MuJoCo world of two robots, and the game played in it."""

from ..games.duel import DuelResult, Outcome, run_duel
from ..games.settings import DuelSettings

__all__ = ["DuelResult", "DuelSettings", "Outcome", "run_duel"]
