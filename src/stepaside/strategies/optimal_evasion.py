"""The best that can be done on an open floor, by the tables of the bound."""

from dataclasses import dataclass, field

from ..planning import Direction
from .knowledge import Intent, Knowledge
from .look_ahead import LookAhead, LookAheadMemory

TURNS = 15  # that one step may have


@dataclass(frozen=True, slots=True)
class Optimal:
    """Take the step from which the best closest approach is largest.

    The table knows of an open floor: what stands there is not heeded.

    Attributes:
        cells: Of the table.
        step: Looks one step ahead.
    """

    cells: int = 64
    step: LookAhead = field(init=False)

    def __post_init__(self) -> None:
        """Prepare looking one step ahead."""
        step = LookAhead(pieces=(1,), turns=TURNS, tail=0, cells=self.cells)
        object.__setattr__(self, "step", step)

    @property
    def direction(self) -> Direction:
        """Backward, eq. (3)."""
        return Direction.BACKWARD

    @property
    def saturated(self) -> bool:
        """It turns by (4)."""
        return False

    def begin(self) -> LookAheadMemory:
        """Nothing seen."""
        return self.step.begin()

    def decide(
        self, knowledge: Knowledge, memory: LookAheadMemory
    ) -> tuple[Intent, LookAheadMemory]:
        """Step to where the table is highest."""
        from dataclasses import replace

        return self.step.decide(replace(knowledge, obstacles=()), memory)
