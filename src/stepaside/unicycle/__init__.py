"""Pursuit and evasion with unicycles (paper, Sec. II)."""

from .circles import circles_of, find_circles
from .circling import Circle, circle_of, find_circle
from .kernel import Outcomes, play_games
from .laws import MOVE_ASIDE, MOVE_BACK, Game, SideRule, TurningLaw, make_game
from .relative import Start
from .sampled import simulate_sampled
from .simulate import PlayedGame, simulate

__all__ = [
    "MOVE_ASIDE",
    "MOVE_BACK",
    "Circle",
    "Game",
    "Outcomes",
    "PlayedGame",
    "SideRule",
    "Start",
    "TurningLaw",
    "circle_of",
    "circles_of",
    "find_circle",
    "find_circles",
    "make_game",
    "play_games",
    "simulate",
    "simulate_sampled",
]
