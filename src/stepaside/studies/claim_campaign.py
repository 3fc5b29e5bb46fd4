"""Every claim of the paper beside its measurement, over many runs."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from pathlib import Path
from typing import Any, NamedTuple

from ..core.errors import OutputError
from ..core.worker_pool import give_up
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
        """Name of the file that keeps its readings, less the suffix."""
        return f"{self.job}-seed{self.seed}"


def key_of(trial: ClaimTrial, job: ClaimJob) -> Key:
    """All that the readings of a trial depend on."""
    return {
        "job": trial.job,
        "seed": trial.seed,
        "settings": job.settings(trial.seed),
        "version": code_version(job.rooms),
        "libraries": library_versions(job.libraries),
    }


def run_trial(trial: ClaimTrial) -> Readings:
    """Measure the claims of a job once."""
    return JOBS[trial.job].measure(trial.seed)


def trials(
    seeds: Sequence[int], jobs: Mapping[str, ClaimJob]
) -> dict[str, list[ClaimTrial]]:
    """Runs of each job: one for each seed where the seed matters, else one."""
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
    tell: Callable[[Path], None] = lambda file: None,
    lost: Callable[[OutputError], None] | None = None,
) -> list[dict[str, Any]]:
    """Measure every claim; what a folder holds already is kept.

    A reading is measured again when the code, the settings or the libraries
    change that it depends on. Readings are kept as they come, so that a run
    that was stopped goes on where it was.

    Args:
        folder: Where readings are kept; None keeps nothing.
        seeds: Seeds of the physical runs.
        executor: Any executor of ``concurrent.futures``; None measures here.
        report: Called with the number of runs done and of all runs.
        tell: Told which files were torn or foreign, and set aside.
        lost: Told why readings could not be kept, which goes on then.

    Returns:
        Rows, as JSON objects.

    Raises:
        OutputError: If readings cannot be kept and nobody is told.
    """
    kept, plan = ReadingStore(folder, tell), trials(seeds, JOBS)
    found: dict[ClaimTrial, Readings] = {}
    missing: list[ClaimTrial] = []
    total = sum(len(runs) for runs in plan.values())
    for name, runs in plan.items():
        wanted = [claim.key for claim in JOBS[name].claims]
        for trial in runs:
            key = key_of(trial, JOBS[name])
            readings = kept.load(trial.file, key, wanted)
            if readings is None:
                missing.append(trial)
            else:
                found[trial] = readings
    if report is not None:
        report(len(found), total)

    def done(trial: ClaimTrial, readings: Readings) -> None:
        found[trial] = readings
        try:
            kept.store(trial.file, key_of(trial, JOBS[trial.job]), readings)
        except OutputError as error:
            if lost is None:
                raise
            lost(error)
        if report is not None:
            report(len(found), total)

    # Seed by seed, so that a run that is stopped has whole seeds.
    _run(sorted(missing, key=lambda trial: trial.seed), executor, done)
    rows: list[ClaimRow] = []
    for name, runs in plan.items():
        job = JOBS[name]
        readings_of_runs = [found[trial] for trial in runs]
        rows += job.rows(name, readings_of_runs, code_version(job.rooms))
    return [row.to_json() for row in rows]


def _run(
    missing: Sequence[ClaimTrial],
    executor: Executor | None,
    done: Callable[[ClaimTrial, Readings], None],
) -> None:
    """Run trials, and tell of each as it comes."""
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
        give_up(executor, futures)
        raise


def provenance(seed: int) -> dict[str, dict[str, Any]]:
    """Version, libraries and settings of each job, for a first seed."""
    return {
        name: {
            "version": code_version(job.rooms),
            "libraries": library_versions(job.libraries),
            "settings": job.settings(seed if job.seeded else 0),
        }
        for name, job in JOBS.items()
    }
