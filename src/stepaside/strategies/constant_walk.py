"""Strategies that ignore the opponent: walk or stand."""

from dataclasses import dataclass

from ..planning import Direction
from .knowledge import Intent, Knowledge


@dataclass(frozen=True, slots=True)
class Walk:
    """Walk with a constant desired heading.

    Attributes:
        bearing: Desired heading in the frame of each support foot, in [rad].
        direction: Whether the robot walks forward or backward.
        saturated: Whether it turns by (6) instead of (8).
        speed_factor: Fraction of the gait's speed, in [0, 1]; 0 stands.
        pace: Fraction of the gait's step rate, in (0, 1].
    """

    bearing: float = 0.0
    direction: Direction = Direction.FORWARD
    saturated: bool = False
    speed_factor: float = 1.0
    pace: float = 1.0

    def __post_init__(self) -> None:
        """Validate the settings."""
        Intent(self.bearing, self.speed_factor, pace=self.pace)

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Return the constant intent."""
        moving = self.speed_factor != 0.0
        return Intent(self.bearing, self.speed_factor, moving, self.pace), None


@dataclass(frozen=True, slots=True)
class StandStill(Walk):
    """Stand still: the baseline of an evader that does nothing."""

    direction: Direction = Direction.BACKWARD
    speed_factor: float = 0.0
