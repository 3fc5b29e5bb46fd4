"""Optimal evasion: differential games of two unicycles solved on a grid."""

from .relative_game import BoundGame, against_any, against_pursuit
from .state_grid import Grid
from .value_solver import DiscretisationScheme, count_steps, solve_bound
from .value_table import Bound, load_bound

__all__ = [
    "Bound",
    "BoundGame",
    "Grid",
    "DiscretisationScheme",
    "against_any",
    "against_pursuit",
    "count_steps",
    "load_bound",
    "solve_bound",
]
