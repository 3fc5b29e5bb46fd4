"""Studies of commands: run with a progress bar, and ended."""

from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import click

from .options import TextType
from .terminal import exit_interrupted, resume_message

if TYPE_CHECKING:
    from ..studies.study import Study, StudyRun

C = TypeVar("C")
PROCESSES = "processes"


def _executor(text: str) -> str:
    from ..studies.study import check_executor

    check_executor(text)
    return text


executor_option = click.option(
    "--executor",
    type=TextType("EXECUTOR", _executor),
    default=PROCESSES,
    show_default=True,
    help="Where cases run: processes, dask, dask:tcp://HOST:PORT or "
    "MODULE:FACTORY; see docs/campaigns.md.",
)


def run_stored(
    study: "Study[C]",
    file: Path | None,
    *,
    workers: int | None = None,
    executor: str = PROCESSES,
    shard: tuple[int, int] = (1, 1),
) -> "StudyRun[C]":
    """Run a study, or one shard of it; a single case in this process."""
    from ..studies.study import run_study

    inline = executor == PROCESSES and (len(study.cases) == 1 or workers == 1)
    return run_study(
        study,
        file,
        executor=None if inline else executor,
        workers=None if inline else workers,
        shard=shard,
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
