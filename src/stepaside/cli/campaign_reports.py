"""Execution of campaigns, with messages about records and effort."""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..core.atomic_output import free_file
from ..core.errors import OutputError
from .effort_estimate import SIMULATED, announce_effort
from .terminal import echo

WALK = 20.0  # duration of a trial, in [s]
PUSHES = 8  # typical number of walks in the search for one push limit


class CampaignOutcome(NamedTuple):
    """How a campaign ended.

    Attributes:
        stopped: Whether Ctrl-C interrupted it.
        failed: Error on recording a result; None if there was none.
    """

    stopped: bool = False
    failed: OutputError | None = None

    @property
    def completed(self) -> bool:
        """Whether all work is done and recorded."""
        return not self.stopped and self.failed is None


def run_campaign_work(
    work: Callable[[], object],
    file: Path | None,
    records: Callable[[], Mapping[str, dict[str, Any]]],
) -> CampaignOutcome:
    """Run a campaign until it is complete, interrupted or cannot be recorded.

    If a result cannot be recorded, as on a full disk, later results could
    not be either. The finished results are then written to the folder for
    temporary files, and a message names it.

    Args:
        work: Runs the campaign; appends each result to the record file.
        file: Record file; None if nothing is recorded.
        records: Returns the finished records, by key.
    """
    try:
        work()
    except KeyboardInterrupt:
        return CampaignOutcome(stopped=True)
    except OutputError as error:
        if file is not None:
            _save_elsewhere(file, records())
        return CampaignOutcome(failed=error)
    return CampaignOutcome()


def _save_elsewhere(file: Path, done: Mapping[str, dict[str, Any]]) -> None:
    from ..studies.record_store import RecordStore

    folder = file.parent
    spare = free_file(Path(tempfile.gettempdir()) / f"stepaside-{folder.name}")
    try:
        RecordStore(spare / file.name).write(dict(done))
    except OutputError:
        return
    echo(
        f"stepaside: cannot write to {folder}; finished results are saved in "
        f"{spare}",
        err=True,
    )


def report_set_aside(file: Path) -> None:
    """Report that invalid records were moved to a file."""
    echo(
        f"stepaside: incomplete or foreign records are moved to {file} and "
        "computed again",
        err=True,
    )


def check_records(file: Path | None) -> None:
    """Move incomplete and foreign records out of a file, with a message."""
    from ..studies.record_store import RecordStore

    if file is not None:
        records = RecordStore(file)
        records.read()
        if records.aside:
            report_set_aside(file.with_name(file.name + ".aside"))


def announce_campaign(trials: int, limits: int, workers: int | None) -> None:
    """Print how many walks are planned and how long they take."""
    walks = trials + PUSHES * limits
    announce_effort(
        f"about {walks} walks of {WALK:g} s, fewer if some are recorded",
        walks * WALK / SIMULATED,
        workers,
    )
