"""Outcomes of games."""

from enum import StrEnum


class Outcome(StrEnum):
    """Outcome of a game or a play.

    Bodies are in contact in physics; a body on the floor touches an obstacle.
    """

    COMPLETED = "completed"
    CAPTURED = "captured"
    TOUCHED = "touched"
    FALL = "fall"
    CONTACT = "contact"
    UNREACHABLE = "unreachable"
    FAILED = "failed"
    INTERRUPTED = "interrupted"
