from .gait_settings import PRESETS as PRESETS
from .gait_settings import GaitSettings as GaitSettings
from .gait_settings import SoleRectangle as SoleRectangle
from .maneuver import CenterState as CenterState
from .maneuver import ManeuverPlanner as ManeuverPlanner
from .maneuver import TemplateDrive as TemplateDrive
from .path import Direction as Direction
from .path import Foot as Foot
from .path import Footstep as Footstep
from .plan import ManeuverPlan as ManeuverPlan
from .plan import PlanSamples as PlanSamples

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
    "SoleRectangle",
    "TemplateDrive",
]
