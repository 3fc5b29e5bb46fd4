"""Optimal evasion on an open floor, by the value table of the bound."""

from dataclasses import dataclass, field, replace

from ..arena import NO_OBSTACLES
from .knowledge import Intent, Knowledge
from .look_ahead import LookAhead, LookAheadMemory
from .strategy import BackwardStrategy

TURNS = 15  # tried per step


@dataclass(frozen=True, slots=True)
class OptimalEvasion(BackwardStrategy):
    """Evader that maximises the value of the table after one step.

    The table holds for an open floor: obstacles are ignored.

    Attributes:
        cells: Number of cells along each axis of the table.
        step: Search over one step.
    """

    cells: int = 64
    step: LookAhead = field(init=False)

    def __post_init__(self) -> None:
        """Prepare the search over one step."""
        step = LookAhead(pieces=(1,), turns=TURNS, tail=0, cells=self.cells)
        object.__setattr__(self, "step", step)

    def begin(self) -> LookAheadMemory:
        """Return the memory before the first sighting."""
        return self.step.begin()

    def decide(
        self, knowledge: Knowledge, memory: LookAheadMemory
    ) -> tuple[Intent, LookAheadMemory]:
        """Take the step with the largest value."""
        return self.step.decide(
            replace(knowledge, obstacles_in_map=NO_OBSTACLES), memory
        )
