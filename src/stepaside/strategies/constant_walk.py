"""Walk, or stand, whatever the other does."""

from dataclasses import dataclass

from ..planning import Direction
from .knowledge import STAND, Intent, Knowledge


@dataclass(frozen=True, slots=True)
class Walk:
    """Walk with a bearing that does not depend on anybody.

    Attributes:
        bearing: Desired heading in the frame of each support foot, [rad].
        direction: Whether the robot walks forward or backward.
        saturated: Whether it turns by (6) instead of (8).
        speed_factor: Share of the gait's speed, in [0, 1]; 0 stands.
        pace: Share of its step rate, in (0, 1].
    """

    bearing: float = 0.0
    direction: Direction = Direction.FORWARD
    saturated: bool = False
    speed_factor: float = 1.0
    pace: float = 1.0

    def __post_init__(self) -> None:
        """Refuse what no robot can do."""
        Intent(self.bearing, self.speed_factor, pace=self.pace)

    def begin(self) -> None:
        """It remembers nothing."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Walk on."""
        return Intent(self.bearing, self.speed_factor, pace=self.pace), None


@dataclass(frozen=True, slots=True)
class StandStill:
    """Stay where it is: what happens to an evader that does nothing.

    Attributes:
        direction: Of a step that is never made.
        saturated: Likewise.
    """

    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self) -> None:
        """It remembers nothing."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Stand."""
        return STAND, None
