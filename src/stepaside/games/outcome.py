"""How a game can end."""

from enum import Enum


class Outcome(Enum):
    """How a duel or a walk ended."""

    COMPLETED = "completed"
    FALL = "fall"
    CONTACT = "contact"
    UNREACHABLE = "unreachable"
    FAILED = "failed"
    INTERRUPTED = "interrupted"
