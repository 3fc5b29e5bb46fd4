"""Maneuver planning in closed form (paper, Sec. III); imports numpy only."""

from .footsteps import Foot, Footstep
from .maneuver import CenterState, ManeuverPlanner
from .path import Direction, UnicycleTrajectory
from .plan import ManeuverPlan, PlanSamples
from .settings import PRESETS, GaitSettings, Sole

__all__ = [
    "PRESETS",
    "CenterState",
    "Direction",
    "Foot",
    "Footstep",
    "GaitSettings",
    "ManeuverPlan",
    "ManeuverPlanner",
    "PlanSamples",
    "Sole",
    "UnicycleTrajectory",
]
