"""What every strategy is: pure, with its memory as a value."""

from typing import Any, Protocol

from ..planning import Direction
from .knowledge import Intent, Knowledge


class Strategy(Protocol):
    """A player's way from what it knows to what it wants.

    A strategy never changes. What it has to remember is a value of its own
    type that it is given and gives back, so that the same knowledge and
    memory always have the same answer, in whatever body.

    Attributes:
        direction: Whether the body drives forward (1) or backward (3).
        saturated: Whether it turns by (6) instead of (8).
    """

    @property
    def direction(self) -> Direction:
        """Whether the body drives forward (1) or backward (3)."""

    @property
    def saturated(self) -> bool:
        """Whether it turns by (6) instead of (8)."""

    def begin(self) -> Any:
        """Memory of a player that has not seen anybody yet."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Decide, when standing at every tick and under way at every step.

        Args:
            knowledge: What is known now.
            memory: What the last decision left, or :meth:`begin` gave.

        Returns:
            What the player wants, and what it remembers from now on.
        """
