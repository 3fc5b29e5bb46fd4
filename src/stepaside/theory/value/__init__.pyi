from .chauffeur import ChauffeurGame, solve_chauffeur
from .outcomes import PoseGrid
from .shield_game import ShieldGame, ShieldTable, solve_shield
from .table import PursuerLaw, ValueTable, load_table, solve_game, sub_poses
from .two_cars import CarGame, solve_cars

__all__ = [
    "CarGame",
    "ChauffeurGame",
    "PoseGrid",
    "PursuerLaw",
    "ShieldGame",
    "ShieldTable",
    "ValueTable",
    "load_table",
    "solve_cars",
    "solve_chauffeur",
    "solve_game",
    "solve_shield",
    "sub_poses",
]
