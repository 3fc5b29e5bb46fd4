"""The game in steps: what one step does, and looking many steps ahead."""

from .candidate_maneuvers import Aims, Found, Maneuvers
from .step_motion import Both, StepRules
from .value_lookup import NO_VALUE, ValueTable

__all__ = [
    "NO_VALUE",
    "Aims",
    "Both",
    "Found",
    "Maneuvers",
    "StepRules",
    "ValueTable",
]
