"""Control of one robot (paper, Fig. 4): perceive, plan, move."""

from .body import Body
from .phase import Phase
from .scheme import ControlScheme

__all__ = ["Body", "ControlScheme", "Phase"]
