"""Evaluation of a strategy that may be user code."""

from typing import Any

from ..core.errors import StrategyError
from .knowledge import Intent, Knowledge
from .strategy import Strategy

# sys.exit() in user code must not end the program.
FAILURES = (Exception, SystemExit)


def evaluate_strategy(
    strategy: Strategy, knowledge: Knowledge, memory: Any
) -> tuple[Intent, Any]:
    """Evaluate one decision of a strategy.

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
    return intent, memory
