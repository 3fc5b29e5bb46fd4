"""Asking a strategy that anybody may have written."""

from typing import Any

from ..core.errors import StrategyError
from .knowledge import Intent, Knowledge
from .strategy import Strategy

# Of code that is not ours: sys.exit() in it must not end the program.
FAILURES = (Exception, SystemExit)


def ask(
    strategy: Strategy, knowledge: Knowledge, memory: Any
) -> tuple[Intent, Any]:
    """Return the answer of a strategy.

    Args:
        strategy: Any.
        knowledge: What the player knows.
        memory: What it remembers.

    Returns:
        What it wants, and what it remembers from now on.

    Raises:
        StrategyError: If it fails, exits, or gives no intent.
    """
    try:
        intent, memory = strategy.decide(knowledge, memory)
    except FAILURES as error:
        raise StrategyError(f"{type(error).__name__}: {error}") from error
    if not isinstance(intent, Intent):
        raise StrategyError(f"decide gave no Intent, got {intent!r}")
    return intent, memory
