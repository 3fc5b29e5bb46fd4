"""Homicidal chauffeur: a car chases a point that moves in any direction."""

from .chauffeur_game import ChauffeurGame, SpeedEllipse
from .chauffeur_table import ChauffeurTable
from .sampled_value import solve_chauffeur

__all__ = [
    "ChauffeurGame",
    "ChauffeurTable",
    "SpeedEllipse",
    "solve_chauffeur",
]
