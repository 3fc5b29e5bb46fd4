"""Campaign that measures every claim of the paper over many runs."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from pathlib import Path
from typing import Any, NamedTuple

from ..core.errors import OutputError
from ..core.worker_pool import cancel_pending
from .claim_jobs import JOBS
from .claims import ClaimJob, ClaimRow, Readings
from .code_version import code_version, library_versions
from .reading_store import Key, ReadingStore


class ClaimTrial(NamedTuple):
    """One run of a job.

    Attributes:
        job: Name of the job.
        seed: Seed of the run; 0 where the seed does not matter.
    """

    job: str
    seed: int

    @property
    def file(self) -> str:
        """Name of the file of its readings, without suffix."""
        return f"{self.job}-seed{self.seed}"


def key_of(trial: ClaimTrial, job: ClaimJob) -> Key:
    """Return everything that the readings of a trial depend on."""
    return {
        "job": trial.job,
        "seed": trial.seed,
        "settings": job.settings(trial.seed),
        "version": code_version(job.modules),
        "libraries": library_versions(job.libraries),
    }


def run_trial(trial: ClaimTrial) -> Readings:
    """Measure the claims of a job once."""
    return JOBS[trial.job].measure(trial.seed)


def trials(
    seeds: Sequence[int], jobs: Mapping[str, ClaimJob]
) -> dict[str, list[ClaimTrial]]:
    """Return the runs of each job: one per seed, or one if not seeded."""
    return {
        name: [
            ClaimTrial(name, seed) for seed in (seeds if job.seeded else (0,))
        ]
        for name, job in jobs.items()
    }


def reproduce(
    folder: Path | None,
    seeds: Sequence[int],
    executor: Executor | None = None,
    report: Callable[[int, int], None] | None = None,
    on_set_aside: Callable[[Path], None] = lambda file: None,
    on_store_error: Callable[[OutputError], None] | None = None,
) -> list[dict[str, Any]]:
    """Measure every claim; readings stored in the folder are reused.

    A reading is measured again if the code, the settings or the libraries
    that it depends on have changed. Readings are stored one by one, so an
    interrupted campaign continues where it stopped.

    Args:
        folder: Folder of the readings; None stores nothing.
        seeds: Seeds of the physical runs.
        executor: Any executor of ``concurrent.futures``; None measures in
            this process.
        report: Called with the number of finished runs and of all runs.
        on_set_aside: Called with each invalid file that was set aside.
        on_store_error: Called with the error if readings cannot be stored;
            the campaign continues.

    Returns:
        Rows, as JSON objects.

    Raises:
        OutputError: If readings cannot be stored, without
            ``on_store_error``.
    """
    store = ReadingStore(folder, on_set_aside)
    plan = trials(seeds, JOBS)
    found: dict[ClaimTrial, Readings] = {}
    missing: list[ClaimTrial] = []
    total = sum(len(runs) for runs in plan.values())
    for name, runs in plan.items():
        wanted = [claim.key for claim in JOBS[name].claims]
        for trial in runs:
            key = key_of(trial, JOBS[name])
            readings = store.load(trial.file, key, wanted)
            if readings is None:
                missing.append(trial)
            else:
                found[trial] = readings
    if report is not None:
        report(len(found), total)

    def done(trial: ClaimTrial, readings: Readings) -> None:
        found[trial] = readings
        try:
            store.store(trial.file, key_of(trial, JOBS[trial.job]), readings)
        except OutputError as error:
            if on_store_error is None:
                raise
            on_store_error(error)
        if report is not None:
            report(len(found), total)

    # Seed by seed, so that an interrupted campaign has complete seeds.
    _run(sorted(missing, key=lambda trial: trial.seed), executor, done)
    rows: list[ClaimRow] = []
    for name, runs in plan.items():
        job = JOBS[name]
        readings_of_runs = [found[trial] for trial in runs]
        rows += job.rows(name, readings_of_runs, code_version(job.modules))
    return [row.to_json() for row in rows]


def _run(
    missing: Sequence[ClaimTrial],
    executor: Executor | None,
    done: Callable[[ClaimTrial, Readings], None],
) -> None:
    """Run trials and report each when it is finished."""
    if executor is None:
        for trial in missing:
            done(trial, run_trial(trial))
        return
    futures: dict[Future[Readings], ClaimTrial] = {
        executor.submit(run_trial, trial): trial for trial in missing
    }
    try:
        for future in as_completed(futures):
            done(futures[future], future.result())
    except BaseException:
        cancel_pending(executor, futures)
        raise


def provenance(seed: int) -> dict[str, dict[str, Any]]:
    """Return version, libraries and settings of each job, for one seed."""
    return {
        name: {
            "version": code_version(job.modules),
            "libraries": library_versions(job.libraries),
            "settings": job.settings(seed if job.seeded else 0),
        }
        for name, job in JOBS.items()
    }
