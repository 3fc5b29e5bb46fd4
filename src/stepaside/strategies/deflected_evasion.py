"""Move aside, deflected by what stands around."""

from dataclasses import dataclass, field
from math import atan2, cos, sin

from ..arena import obstacle_set
from ..core.errors import ConfigurationError, check_positive
from ..core.poses import wrap_angle
from ..planning import Direction
from .evasion import Evasion, EvasionMemory
from .knowledge import Intent, Knowledge

NEAREST = 0.01  # to a solid that still counts, in [m]
SMALL = 1e-4  # way over which a slope is taken, in [m]
ALWAYS = Evasion(safety_radius=1e6)  # evades from the first sight on


@dataclass(frozen=True, slots=True)
class DeflectedEvasion:
    """Walk where the paper's evader would, pushed off by a repulsive field.

    Each solid pushes along the way out of it with
    :math:`s (1 / c - 1 / c_0)`, where c is the distance of the body to it.

    Attributes:
        evasion: The paper's evader.
        reach: Distance c_0 from which on nothing pushes, in [m].
        strength: How hard it pushes, s, in [m].
        body_radius: Of the own body, in [m].
    """

    evasion: Evasion = field(default_factory=lambda: ALWAYS)
    reach: float = 0.6
    strength: float = 0.2
    body_radius: float = 0.2

    def __post_init__(self) -> None:
        """Refuse what does not push."""
        error = ConfigurationError
        check_positive(self.reach, "reach", "m", error)
        check_positive(self.strength, "strength", "m", error)
        check_positive(self.body_radius, "body_radius", "m", error)

    @property
    def direction(self) -> Direction:
        """Backward, eq. (3)."""
        return Direction.BACKWARD

    @property
    def saturated(self) -> bool:
        """It turns as the paper's evader does."""
        return self.evasion.saturated

    def begin(self) -> EvasionMemory:
        """Not evading, on no side yet."""
        return self.evasion.begin()

    def decide(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Add what pushes to where the paper's evader would go."""
        intent, memory = self.evasion.decide(knowledge, memory)
        if not intent.walks or not knowledge.obstacles:
            return intent, memory
        pose = knowledge.pose
        back = pose.theta + intent.heading
        x, y = -cos(back), -sin(back)  # it walks backward
        places = [(pose.x, pose.y), (pose.x + SMALL, pose.y)]
        places.append((pose.x, pose.y + SMALL))
        clearances = obstacle_set(knowledge.obstacles).clearances(places)
        for here, east, north in clearances.T.tolist():
            gap = max(here - self.body_radius, NEAREST)
            if gap >= self.reach:
                continue
            push = self.strength * (1.0 / gap - 1.0 / self.reach)
            x += push * (east - here) / SMALL
            y += push * (north - here) / SMALL
        heading = wrap_angle(atan2(-y, -x) - pose.theta)
        return Intent(heading), memory
