"""Head for where the other will be."""

from dataclasses import dataclass
from math import atan2, cos, sin

from ..errors import ConfigurationError, check_not_negative
from ..planning import Direction
from ..poses import wrap_angle
from .knowledge import Intent, Knowledge
from .other import Trace, heading_of_way, note


@dataclass(frozen=True, slots=True)
class LeadPursuit:
    """Point ahead of the other, along the way that it takes.

    Attributes:
        lead: How far ahead, as a share of the distance; 0 points at the
            other, as the paper's pursuer does.
    """

    lead: float = 0.5

    def __post_init__(self) -> None:
        """Refuse to lag behind."""
        check_not_negative(self.lead, "lead", "1", ConfigurationError)

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    @property
    def saturated(self) -> bool:
        """It turns by (2)."""
        return False

    def begin(self) -> Trace:
        """Nothing seen."""
        return ()

    def decide(
        self, knowledge: Knowledge, memory: Trace
    ) -> tuple[Intent, Trace]:
        """Point at the other until its way is known, then ahead of it."""
        trace = note(memory, knowledge)
        way = heading_of_way(trace)
        if way is None:
            return Intent(knowledge.bearing), trace
        seen, reach = trace[-1], self.lead * knowledge.distance
        x = seen.x + reach * cos(way) - seen.own_x
        y = seen.y + reach * sin(way) - seen.own_y
        return Intent(wrap_angle(atan2(y, x) - seen.own_theta)), trace
