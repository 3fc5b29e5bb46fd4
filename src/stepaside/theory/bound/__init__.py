"""Optimal evasion: differential games of two unicycles solved on a grid."""

from .relative_game import BoundGame, fixed_pursuit_game, two_car_game
from .state_grid import Grid
from .value_solver import count_steps, solve_bound
from .value_table import Bound, load_bound

__all__ = [
    "Bound",
    "BoundGame",
    "Grid",
    "two_car_game",
    "fixed_pursuit_game",
    "count_steps",
    "load_bound",
    "solve_bound",
]
