"""Sampled game of a robot that must never be touched, solved on a grid."""

from .shield_game import PersonModel, PoseGrid, ShieldGame, sub_poses
from .shield_solver import solve_shield
from .shield_table import ShieldTable

__all__ = [
    "PersonModel",
    "PoseGrid",
    "ShieldGame",
    "ShieldTable",
    "solve_shield",
    "sub_poses",
]
