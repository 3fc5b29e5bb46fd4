"""Interface of a strategy: a pure function with its memory as a value."""

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi
from typing import Any, ClassVar, Protocol, runtime_checkable

from ..core.poses import wrap_angle
from ..planning import Direction
from .knowledge import ON_THE_SPOT, STAND, Intent, Knowledge, Limits


@runtime_checkable
class Strategy(Protocol):
    """Pure function from knowledge and memory to an intent.

    It has no mutable state: the same knowledge and memory, a value of its own
    type, always give the same decision, on any level of the game.
    """

    @property
    def direction(self) -> Direction:
        """Whether the body drives forward (1) or backward (3)."""

    @property
    def saturated(self) -> bool:
        """Whether it turns by (6) instead of (8)."""

    def begin(self) -> Any:
        """Return the memory before the first sighting."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Decide: at every tick while standing, at every step while walking.

        The memory is what the last decision, or :meth:`begin`, returned.
        """


class BodyStrategy:
    """Base of strategies that decide by where the body is, sway included.

    The odometry of their robot adds up its gyro, too (docs/shield.md).
    """

    __slots__ = ()

    @property
    def assumes(self) -> str:
        """What it assumes of the body; empty for what is measured."""
        return ""


class BackwardStrategy:
    """Base of evaders that drive backward, eq. (3), and turn by (8)."""

    __slots__ = ()

    direction: ClassVar = Direction.BACKWARD
    saturated: ClassVar = False


@dataclass(frozen=True, slots=True)
class Walk:
    """Walk with a constant desired heading."""

    bearing: float = 0.0  # heading in the frame of each foot [rad]
    direction: Direction = Direction.FORWARD
    saturated: bool = False  # whether it turns by (6) instead of (8)
    speed_factor: float = 1.0  # fraction of the gait's speed [0, 1]; 0 stands

    def __post_init__(self) -> None:
        """Validate the settings."""
        Intent(self.bearing, self.speed_factor)

    def begin(self) -> None:
        """Return no memory."""

    def decide(
        self, knowledge: Knowledge, memory: None
    ) -> tuple[Intent, None]:
        """Return the constant intent."""
        return Intent(self.bearing, self.speed_factor), None


@dataclass(frozen=True, slots=True)
class StandStill(Walk):
    """Stand still: the baseline of an evader that does nothing."""

    direction: Direction = Direction.BACKWARD
    speed_factor: float = 0.0


def unicycle_intent(
    intent: Intent, limits: Limits, direction: Direction
) -> Intent:
    """Return the intent of a unicycle that is nearest to a body velocity.

    It turns its direction of driving to that of the horizontal velocity, and
    meanwhile drives at the component along it, or turns on the spot where
    that is negative. The desired turning rate counts where no horizontal
    velocity is desired.
    """
    if intent.velocity is None:
        return intent
    if not intent.walks:
        return STAND
    ahead, left, turn = intent.velocity
    speed = hypot(ahead, left)
    if speed == 0.0:
        heading, share = min(max(turn / limits.gain, -pi), pi), 0.0
    else:
        reverse = 0.0 if direction is Direction.FORWARD else pi
        heading = wrap_angle(atan2(left, ahead) + reverse)
        share = speed * cos(heading) / limits.speed
    return replace(
        intent,
        heading=heading,
        speed_factor=min(max(share, ON_THE_SPOT), 1.0),
        velocity=None,
    )
