"""Studies of commands: run with a progress bar, and ended."""

from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import click

from ..core.progress import show_progress
from ..studies.executors import PROCESSES, SPECIFICATIONS, check_executor
from .options import TextType
from .terminal import echo, exit_interrupted, resume_message

if TYPE_CHECKING:
    from ..studies.study import Study, StudyProgress, StudyRun

C = TypeVar("C")


def _executor(text: str) -> str:
    check_executor(text)
    return text


executor_option = click.option(
    "--executor",
    type=TextType("EXECUTOR", _executor),
    default=PROCESSES,
    show_default=True,
    help=f"Where cases run: {SPECIFICATIONS}; see docs/campaigns.md.",
)


def run_with_bar(
    study: "Study[C]",
    file: Path | None,
    unit: str,
    *,
    workers: int | None = None,
    executor: str = PROCESSES,
    shard: tuple[int, int] = (1, 1),
) -> "StudyRun[C]":
    """Run a study, or one shard of it, with progress on standard error.

    Args:
        study: Study; a single case is measured in this process.
        file: SQLite file of the records; None to store nothing.
        unit: Unit of the progress, like ``games``.
        workers: Number of processes; all cores if None.
        executor: Specification of the executor.
        shard: Number of the shard, from 1, and number of shards.

    Returns:
        The results; see :func:`finish_study`.
    """
    from ..studies.study import run_study

    inline = executor == PROCESSES and (len(study.cases) == 1 or workers == 1)
    total = len(range(shard[0] - 1, len(study.cases), shard[1]))
    with show_progress(study.name, total, unit) as bar:

        def report(progress: "StudyProgress") -> None:
            bar.initial, bar.n = progress.reused, progress.finished
            bar.refresh()

        return run_study(
            study,
            file,
            executor=None if inline else executor,
            workers=None if inline else workers,
            shard=shard,
            report=report,
            warn=lambda message: echo(message, err=True),
        )


def finish_study(run: "StudyRun[C]", unit: str) -> None:
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
