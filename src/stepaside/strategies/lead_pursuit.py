"""Head for where the other will be."""

from dataclasses import dataclass
from math import atan2, cos, sin

from ..core.errors import ConfigurationError, check_not_negative
from ..core.poses import wrap_angle
from .knowledge import Knowledge
from .opponent_track import OpponentSighting, PathPursuit


@dataclass(frozen=True, slots=True)
class LeadPursuit(PathPursuit):
    """Point ahead of the other, along the way that it takes.

    Attributes:
        lead: How far ahead, as a share of the distance; 0 points at the
            other, as the paper's pursuer does.
    """

    lead: float = 0.5

    def __post_init__(self) -> None:
        """Refuse to lag behind."""
        check_not_negative(self.lead, "lead", "1", ConfigurationError)

    def heading(
        self, knowledge: Knowledge, seen: OpponentSighting, way: float
    ) -> float:
        """Heading for a point ahead of the other."""
        reach = self.lead * knowledge.distance
        x = seen.x + reach * cos(way) - seen.own_x
        y = seen.y + reach * sin(way) - seen.own_y
        return wrap_angle(atan2(y, x) - seen.own_theta)
