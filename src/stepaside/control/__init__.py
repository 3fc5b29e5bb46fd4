"""Control of one robot (paper, Fig. 4): perceive, plan, move."""

from .body import Body, Measurement, Sighting
from .phase import Phase
from .roles import Evasion, Pursuit, Role
from .scheme import ControlScheme

__all__ = [
    "Body",
    "ControlScheme",
    "Evasion",
    "Measurement",
    "Phase",
    "Pursuit",
    "Role",
    "Sighting",
]
