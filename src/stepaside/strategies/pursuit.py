"""Head for the other (paper, Sec. II-A)."""

from dataclasses import dataclass

from .. import laws
from ..planning import Direction
from .knowledge import Intent, Knowledge


@dataclass(frozen=True, slots=True)
class Pursuit:
    """Head for the other, always: the pursuer knows of the evader.

    Attributes:
        saturated: Whether to turn by (6) instead of (8).
    """

    saturated: bool = False

    @property
    def direction(self) -> Direction:
        """Forward, eq. (1)."""
        return Direction.FORWARD

    def begin(self) -> None:
        """It remembers nothing."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Point at the other, eq. (2)."""
        return Intent(laws.pursuit_heading(knowledge.bearing)), None
