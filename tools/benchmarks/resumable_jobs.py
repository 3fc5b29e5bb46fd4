"""Parallel jobs that can be interrupted and continued."""

import shutil
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from tqdm import tqdm

from stepaside.studies.campaign import (
    CampaignProgress,
    CodeStamp,
    Study,
    StudyRun,
    run_study,
)
from stepaside.studies.executors import Engine, open_engine
from stepaside.studies.result_store import ResultStore

Row = dict[str, Any]
Job = TypeVar("Job")
C = TypeVar("C")


def complete(
    study: Study[C],
    store: ResultStore | None,
    workers: int | None = None,
) -> StudyRun[C]:
    """Run a study to its end, with a progress bar.

    Args:
        study: Study.
        store: Store of its records; None for a temporary one.
        workers: Number of processes; all cores by default, 0 for this one.

    Raises:
        KeyboardInterrupt: After Ctrl-C; finished cases are stored.
        OutputError: If a record cannot be stored.
    """
    if workers == 0:
        return _complete(study, store, Engine.of(None))
    with open_engine(workers=workers) as engine:
        return _complete(study, store, engine)


def _complete(
    study: Study[C],
    store: ResultStore | None,
    engine: Engine,
) -> StudyRun[C]:
    with tqdm(total=len(study.cases), disable=None) as bar:

        def report(progress: CampaignProgress) -> None:
            bar.initial, bar.n = progress.reused, progress.finished
            bar.refresh()

        run = run_study(study, store, engine, report)
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
            folder with the suffix ``.part``. They are reused if job, version,
            libraries and the code of the command are the same, and deleted by
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
    stamp = CodeStamp(head["version"], head["libraries"])

    def key_of(case: tuple[str, Job]) -> str:
        name, job = case
        digest = sha256(script + repr(job).encode()).hexdigest()[:12]
        return f"{name}/{digest}"

    study = Study(
        "jobs",
        list(jobs.items()),
        partial(_do, do),
        key_of,
        lambda case: stamp,
        ("row",),
    )
    run = complete(study, ResultStore(part_of(output)), workers)
    return {name: record["row"] for (name, _), record in run.items()}


def _do(do: Callable[[Job], Row], case: tuple[str, Job]) -> Row:
    return {"row": do(case[1])}


def finished(output: Path) -> None:
    """Delete the records of finished jobs, once the results are written."""
    shutil.rmtree(part_of(output), ignore_errors=True)


def part_of(output: Path) -> Path:
    """Return the folder of the records."""
    return output.with_suffix(".part")


def spread(values: Sequence[float | None]) -> dict[str, float | int | None]:
    """Return minimum, mean and maximum of the values that are not None."""
    found = [value for value in values if value is not None]
    if not found:
        return {"number": 0, "least": None, "mean": None, "greatest": None}
    return {
        "number": len(found),
        "least": min(found),
        "mean": float(np.mean(found)),
        "greatest": max(found),
    }
