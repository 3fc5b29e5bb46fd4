"""Exit of an interrupted command, with a message about saved results."""

from pathlib import Path
from typing import NoReturn

from ..core.signal_handling import INTERRUPTED
from .terminal import echo

NOTHING_SAVED = "nothing is saved"


def exit_interrupted(message: str = NOTHING_SAVED) -> NoReturn:
    """Report what is saved, and exit with the status of an interruption.

    Args:
        message: Sentence about what is saved.
    """
    echo(f"stepaside: interrupted; {message}", err=True)
    raise SystemExit(INTERRUPTED)


def resume_message(done: str, path: Path | None) -> str:
    """Return a sentence about the saved part of a campaign.

    Args:
        done: Finished part, like ``3 of 10 duels``.
        path: File or folder of the records; None if nothing is recorded.
    """
    if path is None:
        return f"{done} finished; {NOTHING_SAVED} without --output"
    return f"{done} are saved in {path}; run the same command to continue"
