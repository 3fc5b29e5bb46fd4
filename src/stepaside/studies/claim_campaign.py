"""Campaign that measures every claim of the paper over many runs."""

import json
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from hashlib import sha256
from math import isfinite, nan
from typing import Any, NamedTuple

from .campaign import (
    CampaignProgress,
    CodeStamp,
    Study,
    StudyRun,
    code_stamp,
    run_study,
)
from .claim_jobs import JOBS
from .claims import ClaimRow
from .code_version import code_version, library_versions
from .executors import Engine
from .records import Record
from .result_store import ResultStore


class ClaimTrial(NamedTuple):
    """One run of a job.

    Attributes:
        job: Name of the job.
        seed: Seed of the run; 0 where the seed does not matter.
    """

    job: str
    seed: int


def claim_study(seeds: Sequence[int]) -> Study[ClaimTrial]:
    """Return the study of all claims: a run per seed, or one if not seeded.

    Args:
        seeds: Seeds of the physical runs. Cases are ordered by seed, so that
            an interrupted campaign has complete seeds.
    """
    trials = [
        ClaimTrial(name, seed)
        for name, job in JOBS.items()
        for seed in (seeds if job.seeded else (0,))
    ]
    return Study(
        "claims",
        sorted(trials, key=lambda trial: trial.seed),
        run_trial,
        key_of,
        lambda trial: stamp_of(trial.job),
        ("readings",),
    )


def key_of(trial: ClaimTrial) -> str:
    """Return the key of a run: its job, its seed and its settings."""
    job = JOBS[trial.job]
    inputs = [
        job.settings(trial.seed),
        sorted(claim.key for claim in job.claims),
    ]
    digest = sha256(json.dumps(inputs).encode()).hexdigest()[:12]
    return f"{trial.job}/{trial.seed}/{digest}"


def stamp_of(job: str) -> CodeStamp:
    """Return the present versions on which the readings of a job depend."""
    return code_stamp(JOBS[job].modules, JOBS[job].libraries)


def run_trial(trial: ClaimTrial) -> Record:
    """Measure the claims of a job once; NaN and inf become null."""
    found = JOBS[trial.job].measure(trial.seed)
    return {
        "readings": {
            name: value if isfinite(value) else None
            for name, value in found.items()
        }
    }


def claim_rows(run: StudyRun[ClaimTrial]) -> list[dict[str, Any]]:
    """Return one row per claim from a completed run, as JSON objects."""
    readings: dict[str, list[dict[str, float]]] = {name: [] for name in JOBS}
    for trial, record in run.items():
        readings[trial.job].append(
            {
                name: nan if value is None else float(value)
                for name, value in record["readings"].items()
            }
        )
    rows: list[ClaimRow] = []
    for name, job in JOBS.items():
        rows += job.rows(name, readings[name], stamp_of(name).version)
    return [row.to_json() for row in rows]


def reproduce(
    store: ResultStore | None,
    seeds: Sequence[int],
    executor: Executor | Engine | None = None,
    report: Callable[[CampaignProgress], None] | None = None,
) -> list[dict[str, Any]]:
    """Measure every claim; readings in the store are reused.

    Args:
        store: Store of the readings; None stores nothing.
        seeds: Seeds of the physical runs.
        executor: Any executor of ``concurrent.futures``; None measures in
            this process.
        report: Called with the progress.

    Returns:
        Rows, as JSON objects.

    Raises:
        OutputError: If readings cannot be stored.
        KeyboardInterrupt: After Ctrl-C.
    """
    run = run_study(claim_study(seeds), store, executor, report)
    if run.failure is not None:
        raise run.failure
    if run.interrupted:
        raise KeyboardInterrupt
    return claim_rows(run)


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
