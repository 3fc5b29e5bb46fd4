from .chauffeur import ChauffeurGame, SpeedEllipse, solve_chauffeur
from .pose_grid import PoseGrid, sub_poses
from .shield_game import PersonModel, ShieldGame
from .shield_solver import solve_shield
from .shield_table import ShieldTable
from .solver import PursuerLaw, solve_game
from .table import ValueTable, load_table
from .two_cars import CarGame, solve_cars

__all__ = [
    "CarGame",
    "ChauffeurGame",
    "PersonModel",
    "PoseGrid",
    "PursuerLaw",
    "ShieldGame",
    "ShieldTable",
    "SpeedEllipse",
    "ValueTable",
    "load_table",
    "solve_cars",
    "solve_chauffeur",
    "solve_game",
    "solve_shield",
    "sub_poses",
]
