"""Outcomes of games."""

from enum import StrEnum


class Outcome(StrEnum):
    """Outcome of a duel, a walk or a play."""

    COMPLETED = "completed"
    FALL = "fall"
    CONTACT = "contact"
    UNREACHABLE = "unreachable"
    FAILED = "failed"
    INTERRUPTED = "interrupted"
