"""Pursuit and evasion of two unicycles (paper, Sec. II)."""

from .adaptive_simulation import PlayedGame, simulate
from .batch import Outcomes, play_games
from .circles import Circle, circle_of, circles_of, find_circle
from .relative_coordinates import RelativeStart
from .sampled_game import simulate_sampled
from .unicycle_game import (
    MOVE_ASIDE,
    MOVE_BACK,
    Game,
    SideRule,
    TurningLaw,
    make_game,
)

__all__ = [
    "MOVE_ASIDE",
    "MOVE_BACK",
    "Circle",
    "Game",
    "Outcomes",
    "PlayedGame",
    "SideRule",
    "RelativeStart",
    "TurningLaw",
    "circle_of",
    "circles_of",
    "find_circle",
    "make_game",
    "play_games",
    "simulate",
    "simulate_sampled",
]
