"""Parallel jobs that can be interrupted and continued."""

import sys
from collections.abc import Callable, Mapping
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

from stepaside.studies.study import Study, StudyRun, run_study

Row = dict[str, Any]
Job = TypeVar("Job")
C = TypeVar("C")


def complete(
    study: Study[C], file: Path | None, workers: int | None = None
) -> StudyRun[C]:
    """Run a study to its end, with a progress bar.

    Args:
        study: Study.
        file: SQLite file of its records; None for a temporary one.
        workers: Number of processes; all cores by default, 0 for this one.

    Raises:
        KeyboardInterrupt: After Ctrl-C; finished cases are stored.
        OutputError: If a record cannot be stored.
    """
    executor = None if workers == 0 else "processes"
    run = run_study(study, file, executor=executor, workers=workers or None)
    if run.failure is not None:
        raise run.failure
    if run.interrupted:
        raise KeyboardInterrupt
    return run


def gather(
    output: Path,
    head: Mapping[str, Any],
    jobs: Mapping[str, Job],
    do: Callable[[Job], Row],
    workers: int | None = None,
) -> dict[str, Row]:
    """Run the jobs that are not done yet; record results next to the output.

    Args:
        output: File of results to be written. Finished jobs are recorded in a
            file with the suffix ``.sqlite``. They are reused if job, results
            version and the code of the command are the same, and deleted by
            :func:`finished`.
        head: Header of the results.
        jobs: Arguments by name; their ``repr`` must be unique.
        do: Runs one job; a module-level function, as it runs in other
            processes.
        workers: Number of processes; all cores by default, 0 for this one.

    Returns:
        Results in the order of the jobs.
    """
    script = Path(sys.argv[0]).read_bytes()

    def key_of(case: tuple[str, Job]) -> str:
        name, job = case
        digest = sha256(script + repr(job).encode()).hexdigest()[:12]
        return f"{name}/{digest}"

    study = Study(
        "jobs",
        list(jobs.items()),
        partial(_do, do),
        key_of,
    )
    run = complete(study, part_of(output), workers)
    return {name: record["row"] for (name, _), record in run.items()}


def _do(do: Callable[[Job], Row], case: tuple[str, Job]) -> Row:
    return {"row": do(case[1])}


def finished(output: Path) -> None:
    """Delete the records of finished jobs, once the results are written."""
    part_of(output).unlink(missing_ok=True)


def part_of(output: Path) -> Path:
    """Return the file of the records."""
    return output.with_suffix(".sqlite")
