"""Interface of a strategy: a pure function with its memory as a value."""

from typing import Any, ClassVar, Protocol, runtime_checkable

from ..core.errors import StrategyError
from ..core.user_file import FAILURES
from ..planning import Direction
from .knowledge import Intent, Knowledge
from .nearest_unicycle_intent import unicycle_intent


@runtime_checkable
class Strategy(Protocol):
    """Pure function from knowledge and memory to an intent.

    A strategy has no mutable state. Its memory is a value of its own type
    that is passed in and returned, so that the same knowledge and memory
    always give the same decision, on any level of the game.

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
        """Return the memory before the first sighting."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Decide: at every tick while standing, at every step while walking.

        Args:
            knowledge: Knowledge of the player.
            memory: Memory that the last decision, or :meth:`begin`, returned.

        Returns:
            Intent and new memory.
        """


class BackwardStrategy:
    """Base of evaders that drive backward, eq. (3), and turn by (8)."""

    __slots__ = ()

    direction: ClassVar = Direction.BACKWARD
    saturated: ClassVar = False


def evaluate_strategy(
    strategy: Strategy, knowledge: Knowledge, memory: Any
) -> tuple[Intent, Any]:
    """Evaluate one decision of a strategy.

    A body velocity becomes the nearest intent of a unicycle, unless the legs
    have a velocity set.

    Args:
        strategy: Strategy, possibly user code.
        knowledge: Knowledge of the player.
        memory: Memory of the player.

    Returns:
        Intent and new memory.

    Raises:
        StrategyError: If it fails, exits, or returns no intent.
    """
    try:
        intent, memory = strategy.decide(knowledge, memory)
    except FAILURES as error:
        raise StrategyError(f"{type(error).__name__}: {error}") from error
    if not isinstance(intent, Intent):
        raise StrategyError(f"decide must return an Intent, got {intent!r}")
    limits = knowledge.limits
    if intent.velocity is not None and limits.velocities is None:
        intent = unicycle_intent(intent, limits, strategy.direction)
    return intent, memory
