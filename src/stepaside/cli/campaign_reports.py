"""What campaigns say beside their results, and how they end."""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..core.atomic_output import free_file
from ..core.errors import OutputError
from .effort_estimate import SIMULATED, tell_effort
from .terminal import echo

WALK = 20.0  # of a trial, in [s]
PUSHES = 8  # walks in which a limit is found


class CampaignOutcome(NamedTuple):
    """How the work of a campaign ended.

    Attributes:
        stopped: Whether by Ctrl-C.
        failed: Why a result could not be recorded, if one could not.
    """

    stopped: bool = False
    failed: OutputError | None = None

    @property
    def whole(self) -> bool:
        """Whether all of it is done."""
        return not self.stopped and self.failed is None


def gather(
    work: Callable[[], object],
    file: Path | None,
    records: Callable[[], Mapping[str, dict[str, Any]]],
) -> CampaignOutcome:
    """Work until all is done, or until it cannot go on.

    Where a result cannot be recorded, as on a full disk, no other could:
    what is done is recorded elsewhere then, and said where.

    Args:
        work: Does it, and adds each result to a file of records.
        file: Of the records; None if nothing is kept.
        records: What is done so far, as it is recorded, by key.

    Returns:
        How it ended.
    """
    try:
        work()
    except KeyboardInterrupt:
        return CampaignOutcome(stopped=True)
    except OutputError as error:
        if file is not None:
            _keep_elsewhere(file, records())
        return CampaignOutcome(failed=error)
    return CampaignOutcome()


def _keep_elsewhere(file: Path, done: Mapping[str, dict[str, Any]]) -> None:
    from ..studies.record_store import RecordStore

    place = file.parent
    spare = free_file(Path(tempfile.gettempdir()) / f"stepaside-{place.name}")
    try:
        RecordStore(spare / file.name).write(dict(done))
    except OutputError:
        return
    echo(f"stepaside: not in {place}; what is done is in {spare}", err=True)


def tell_aside(file: Path) -> None:
    """Name a file that was torn or foreign, and is done again."""
    echo(
        f"stepaside: what was torn or foreign is set aside in {file} and done "
        "again",
        err=True,
    )


def check_records(file: Path | None) -> None:
    """Set aside what is no whole record of a file, and say so."""
    from ..studies.record_store import RecordStore

    if file is not None:
        records = RecordStore(file)
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
