"""What a command that was stopped says of what it had done."""

from pathlib import Path
from typing import NoReturn

from .options.common_options import INTERRUPTED
from .terminal import echo

NOTHING = "nothing is kept"


def leave_stopped(kept: str = NOTHING) -> NoReturn:
    """Say what is kept, and leave as a command does that was stopped.

    Args:
        kept: What is, in words.
    """
    echo(f"stepaside: interrupted; {kept}", err=True)
    raise SystemExit(INTERRUPTED)


def kept_in(done: str, place: Path | None) -> str:
    """What is kept of a campaign, which goes on there.

    Args:
        done: What is done of it, like ``3 of 10 duels``.
        place: Where it is recorded; None if nowhere.
    """
    if place is None:
        return f"{done} were done, and {NOTHING} without --output"
    return f"{done} are kept in {place}, and the same command goes on"
