"""The game in steps: what one step does, and looking many steps ahead."""

from .maneuvers import Aims, Found, Maneuvers
from .motion import Both, StepRules
from .value import NO_VALUE, ValueTable

__all__ = [
    "NO_VALUE",
    "Aims",
    "Both",
    "Found",
    "Maneuvers",
    "StepRules",
    "ValueTable",
]
