"""Strategy of a player that is controlled from outside."""

from ..planning import Direction
from ..strategies.knowledge import STAND, Intent, Knowledge


class HeldIntent:
    """Strategy that returns the intent that it holds, for learning.

    It is not pure: the intent is replaced from outside, between decisions.

    Attributes:
        direction: Whether the body drives forward or backward.
        saturated: False: it turns by (8).
        intent: The intent.
        known: Knowledge at the last decision; None before.
        steps: Number of decisions while walking.
    """

    saturated = False

    def __init__(self, direction: Direction) -> None:
        """Hold the intent to stand."""
        self.direction = direction
        self.reset()

    def reset(self) -> None:
        """Forget all decisions."""
        self.intent = STAND
        self.known: Knowledge | None = None
        self.steps = 0

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Store the knowledge and return the intent."""
        self.known = knowledge
        self.steps += knowledge.moving
        return self.intent, None
