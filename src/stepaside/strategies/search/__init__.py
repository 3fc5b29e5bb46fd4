"""Step-game model and search: one step, and rollouts of many."""

from .candidate_maneuvers import (
    BestManeuver,
    CandidateManeuvers,
    ManeuverObjective,
)
from .step_motion import PlayerPair, StepRules
from .value_lookup import NO_VALUE, PursuitValues

__all__ = [
    "NO_VALUE",
    "ManeuverObjective",
    "PlayerPair",
    "BestManeuver",
    "CandidateManeuvers",
    "StepRules",
    "PursuitValues",
]
