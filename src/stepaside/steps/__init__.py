"""The game in steps: what one step does, and looking many steps ahead."""

from .maneuvers import Aims, Found, Maneuvers
from .motion import Both, StepRules
from .packed import NOTHING, Packed, pack
from .value import NO_VALUE, ValueTable

__all__ = [
    "NOTHING",
    "NO_VALUE",
    "Aims",
    "Both",
    "Found",
    "Maneuvers",
    "Packed",
    "StepRules",
    "ValueTable",
    "pack",
]
