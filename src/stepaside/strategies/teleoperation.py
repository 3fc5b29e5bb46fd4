"""A pursuer that a hand steers."""

from dataclasses import dataclass
from math import radians

from ..core.errors import ConfigurationError, check_within
from ..planning import Direction
from .knowledge import STAND, Intent, Knowledge

TURN = radians(50.0)  # bearing of a full turn of the hand, in [rad]


@dataclass(frozen=True, slots=True)
class TeleoperatedPursuit:
    """Heads where a hand points; another hold of the hand is another value.

    Attributes:
        turn: From -1, a full turn to the right, to 1, one to the left.
        going: Whether the robot walks.
        saturated: Whether it turns by (6) instead of (8).
    """

    turn: float = 0.0
    going: bool = False
    saturated: bool = False

    def __post_init__(self) -> None:
        """Refuse a turn that no hand can make."""
        check_within(self.turn, -1.0, 1.0, "turn", "1", ConfigurationError)

    @property
    def direction(self) -> Direction:
        """Forward."""
        return Direction.FORWARD

    def begin(self) -> None:
        """The hand remembers."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Go where the hand points, if it lets the robot go."""
        return Intent(self.turn * TURN) if self.going else STAND, None
