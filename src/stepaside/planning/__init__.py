"""Maneuver planning in closed form (paper, Sec. III); imports numpy only."""

from typing import TYPE_CHECKING

from ..doors import door

if TYPE_CHECKING:
    from .footsteps import Foot, Footstep
    from .maneuver import CenterState, ManeuverPlanner
    from .path import Direction, UnicycleTrajectory
    from .plan import ManeuverPlan, PlanSamples
    from .settings import PRESETS, STABILISED, GaitSettings, Sole
else:
    __getattr__ = door(
        __name__,
        {
            "Foot": "footsteps",
            "Footstep": "footsteps",
            "CenterState": "maneuver",
            "ManeuverPlanner": "maneuver",
            "Direction": "path",
            "UnicycleTrajectory": "path",
            "ManeuverPlan": "plan",
            "PlanSamples": "plan",
            "PRESETS": "settings",
            "STABILISED": "settings",
            "GaitSettings": "settings",
            "Sole": "settings",
        },
    )

__all__ = [
    "PRESETS",
    "STABILISED",
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
