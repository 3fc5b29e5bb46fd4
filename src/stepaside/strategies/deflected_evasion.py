"""Evasion deflected by obstacles."""

from dataclasses import dataclass, field
from math import atan2, cos, sin

from ..core.errors import ConfigurationError, check_positive
from ..core.poses import wrap_angle
from ..planning import Direction
from .evasion import Evasion, EvasionMemory
from .knowledge import Intent, Knowledge

MIN_GAP = 0.01  # below which the field grows no further, in [m]
STEP = 1e-4  # of the finite differences, in [m]
ALWAYS = Evasion(safety_radius=1e6)  # evades from the first sighting on


@dataclass(frozen=True, slots=True)
class DeflectedEvasion:
    """The paper's evasion, deflected by a repulsive field.

    Each obstacle repels along the gradient of its clearance with strength
    :math:`s (1 / c - 1 / c_0)`, where c is the clearance of the body.

    Attributes:
        evasion: The paper's evader.
        reach: Clearance c_0 from which the field is zero, in [m].
        strength: Strength s of the field, in [m].
        body_radius: Radius of the own body, in [m].
    """

    evasion: Evasion = field(default_factory=lambda: ALWAYS)
    reach: float = 0.6
    strength: float = 0.2
    body_radius: float = 0.2

    def __post_init__(self) -> None:
        """Validate the settings."""
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
        """Whether it turns by (6) instead of (8), as its evader."""
        return self.evasion.saturated

    def begin(self) -> EvasionMemory:
        """Return the memory of an evader that does not evade yet."""
        return self.evasion.begin()

    def decide(
        self, knowledge: Knowledge, memory: EvasionMemory
    ) -> tuple[Intent, EvasionMemory]:
        """Add the repulsive field to the direction of the paper's evader."""
        intent, memory = self.evasion.decide(knowledge, memory)
        if not intent.walks or not knowledge.obstacles_in_map:
            return intent, memory
        pose = knowledge.pose_in_map
        back = pose.theta + intent.heading
        x, y = -cos(back), -sin(back)  # it walks backward
        points = [(pose.x, pose.y), (pose.x + STEP, pose.y)]
        points.append((pose.x, pose.y + STEP))
        clearances = knowledge.obstacles_in_map.clearances(points)
        for here, east, north in clearances.T.tolist():
            gap = max(here - self.body_radius, MIN_GAP)
            if gap >= self.reach:
                continue
            push = self.strength * (1.0 / gap - 1.0 / self.reach)
            x += push * (east - here) / STEP
            y += push * (north - here) / STEP
        heading = wrap_angle(atan2(-y, -x) - pose.theta)
        return Intent(heading), memory
