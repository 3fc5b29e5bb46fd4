"""Lead pursuit: head for a point ahead of the evader."""

from dataclasses import dataclass
from math import atan2, cos, sin

from ..core.errors import ConfigurationError, check_not_negative
from ..core.poses import wrap_angle
from .knowledge import Knowledge
from .opponent_track import OpponentSighting, PathPursuit


@dataclass(frozen=True, slots=True)
class LeadPursuit(PathPursuit):
    """Pursuer that heads for a point ahead of the evader on its path.

    Attributes:
        lead: Distance of that point from the evader, as a fraction of the
            distance between the players; 0 is the paper's pursuer.
    """

    lead: float = 0.5

    def __post_init__(self) -> None:
        """Validate the lead."""
        check_not_negative(self.lead, "lead", "1", ConfigurationError)

    def heading(
        self, knowledge: Knowledge, sighting: OpponentSighting, course: float
    ) -> float:
        """Return the bearing of the point ahead of the evader, in [rad]."""
        reach = self.lead * knowledge.distance
        x = sighting.x + reach * cos(course) - sighting.own_x
        y = sighting.y + reach * sin(course) - sighting.own_y
        return wrap_angle(atan2(y, x) - sighting.own_theta)
