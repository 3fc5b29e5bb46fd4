"""What campaigns say beside their results."""

from pathlib import Path

from .effort import SIMULATED, tell_effort
from .terminal import echo

WALK = 20.0  # of a trial, in [s]
PUSHES = 8  # walks in which a limit is found


def tell_aside(file: Path) -> None:
    """Name a file that was torn or foreign, and is done again."""
    echo(
        f"stepaside: what was torn or foreign is set aside in {file} and done "
        "again",
        err=True,
    )


def check_records(file: Path | None) -> None:
    """Set aside what is no whole record of a file, and say so."""
    from ..studies.records import RecordFile

    if file is not None:
        records = RecordFile(file)
        records.read()
        if records.aside:
            tell_aside(file.with_name(file.name + ".aside"))


def tell_campaign(trials: int, limits: int, workers: int | None) -> None:
    """Say how many walks are planned, and how long they take."""
    walks = trials + PUSHES * limits
    tell_effort(
        f"about {walks} walks of {WALK:g} s, less those that are recorded",
        walks * WALK / SIMULATED,
        workers,
    )
