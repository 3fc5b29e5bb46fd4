"""A pursuer that a hand steers."""

from dataclasses import dataclass, field
from math import radians

from ..planning import Direction

TURN = radians(50.0)  # bearing of a full turn of the hand, in [rad]


@dataclass(slots=True)
class Driven:
    """Heads where a hand points; the gait stays the planner's.

    Attributes:
        turn: From -1, a full turn to the right, to 1, one to the left.
        going: Whether the robot walks.
        saturated: Whether it turns by (6) instead of (8).
    """

    turn: float = 0.0
    going: bool = False
    saturated: bool = field(default=False)

    @property
    def direction(self) -> Direction:
        """Forward."""
        return Direction.FORWARD

    def is_triggered(self, distance: float) -> bool:
        """Whether the hand lets it walk."""
        return self.going

    def desired_heading(self, bearing: float) -> float:
        """Bearing that the hand asks for, in [rad]."""
        return self.turn * TURN
