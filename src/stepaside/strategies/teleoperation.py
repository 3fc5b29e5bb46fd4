"""Pursuer under teleoperation."""

from dataclasses import dataclass
from math import radians
from typing import ClassVar

from ..core.errors import ConfigurationError, check_within
from ..planning import Direction
from .knowledge import STAND, Intent, Knowledge

TURN = radians(50.0)  # desired heading at full deflection, in [rad]


@dataclass(frozen=True, slots=True)
class TeleoperatedPursuit:
    """Pursuer that an operator steers; each command is a new value.

    Attributes:
        turn: Deflection, from -1, fully to the right, to 1, fully to the
            left.
        going: Whether the robot walks.
        saturated: Whether it turns by (6) instead of (8).
    """

    direction: ClassVar = Direction.FORWARD
    turn: float = 0.0
    going: bool = False
    saturated: bool = False

    def __post_init__(self) -> None:
        """Validate the deflection."""
        check_within(self.turn, -1.0, 1.0, "turn", "1", ConfigurationError)

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Return the intent of the operator."""
        return Intent(self.turn * TURN) if self.going else STAND, None
