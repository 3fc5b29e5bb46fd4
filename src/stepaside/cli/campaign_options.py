"""Options of studies: workers, executor, shard; and their progress."""

import re
from collections.abc import Callable
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from ..core.progress import show_progress
from ..studies.executors import PROCESSES, SPECIFICATIONS, check_executor
from .options.common_options import workers_option
from .options.parameter_types import TextType
from .output_files import note_records, saved_text
from .terminal import echo, exit_interrupted, resume_message

if TYPE_CHECKING:
    from ..studies.study import Study, StudyProgress, StudyRun

C = TypeVar("C")


class ShardType(TextType[tuple[int, int]]):
    """Part of the cases of a campaign: ``2/4`` for the second of four."""

    name = "I/N"

    def parse(self, value: Any) -> tuple[int, int]:
        """Parse the number of a shard and of all shards."""
        if isinstance(value, tuple):
            return value
        found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", str(value).strip())
        if found is None or not 1 <= int(found[1]) <= int(found[2]):
            raise click.BadParameter(
                "must be I/N with integers 1 <= I <= N [1] like 1/4, "
                f"got {value!r}"
            )
        return int(found[1]), int(found[2])


class ExecutorType(TextType[str]):
    """Specification of an executor."""

    name = "EXECUTOR"

    def parse(self, value: Any) -> str:
        """Refuse a specification of no executor."""
        check_executor(str(value))
        return str(value)


executor_option = partial(
    click.option,
    "--executor",
    type=ExecutorType(),
    default=PROCESSES,
    show_default=True,
    help=f"Where cases run: {SPECIFICATIONS}; see docs/campaigns.md.",
)


class CampaignOptions(NamedTuple):
    """Where a study runs, and which part of it.

    Attributes:
        workers: Number of processes; all cores if None.
        executor: Specification of the executor; see
            :func:`~stepaside.studies.executors.open_executor`.
        shard: Number of the shard, from 1, and number of shards.
    """

    workers: int | None
    executor: str
    shard: tuple[int, int]


def campaign_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options of a study, passed as ``campaign``."""

    @workers_option()
    @executor_option()
    @click.option(
        "--shard",
        type=ShardType(),
        default=(1, 1),
        help="Run every N-th case only, from the I-th; `stepaside merge` "
        "joins the files.",
    )
    @wraps(function)
    def command(
        workers: int | None,
        executor: str,
        shard: tuple[int, int],
        **values: Any,
    ) -> Any:
        campaign = CampaignOptions(workers, executor, shard)
        try:
            return function(campaign=campaign, **values)
        except KeyboardInterrupt:
            exit_interrupted(saved_text(click.get_current_context()))

    return command


def run_campaign(
    study: "Study[C]",
    file: Path | None,
    campaign: CampaignOptions,
    unit: str,
) -> "StudyRun[C]":
    """Run a study, or one shard of it, with progress on standard error.

    Args:
        study: Study; a single case is measured in this process.
        file: SQLite file of the records; None to store nothing.
        campaign: Options.
        unit: Unit of the progress, like ``games``.

    Returns:
        The results; see :func:`finish_campaign`.
    """
    from ..studies.study import run_study

    inline = campaign.executor == PROCESSES and (
        len(study.cases) == 1 or campaign.workers == 1
    )
    if file is not None:
        note_records(file)
    number, of = campaign.shard
    total = len(range(number - 1, len(study.cases), of))
    with show_progress(study.name, total, unit) as bar:

        def report(progress: "StudyProgress") -> None:
            bar.initial, bar.n = progress.reused, progress.finished
            bar.refresh()

        return run_study(
            study,
            file,
            executor=None if inline else campaign.executor,
            workers=None if inline else campaign.workers,
            shard=campaign.shard,
            report=report,
            warn=lambda message: echo(message, err=True),
        )


def finish_campaign(run: "StudyRun[C]", unit: str) -> None:
    """End a command whose study could not be completed.

    Raises:
        OutputError: If a record could not be written.
        SystemExit: After Ctrl-C, with the status of its signal.
    """
    if run.failure is not None:
        raise run.failure
    if run.interrupted:
        done = f"{run.finished} of {run.total} {unit}"
        exit_interrupted(resume_message(done, run.file))
