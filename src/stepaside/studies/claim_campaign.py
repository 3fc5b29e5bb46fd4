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
from .claims import ClaimJob, ClaimRow
from .code_version import code_version, library_versions
from .executors import Engine
from .legs_claims import NAME, learned_legs_job
from .records import Record
from .result_store import ResultStore


class ClaimTrial(NamedTuple):
    """One run of a job.

    Attributes:
        job: Name of the job.
        seed: Seed of the run; 0 where the seed does not matter.
        legs: Folder of the robot whose learned legs the job measures; empty
            for jobs of the paper's walk.
    """

    job: str
    seed: int
    legs: str = ""


def jobs_of(legs: str = "") -> dict[str, ClaimJob]:
    """Return the jobs by name.

    Args:
        legs: Folder of a robot whose description names a walking policy; the
            paper's game is measured on it, too. Empty for none.

    Raises:
        ConfigurationError: If the description names no policy.
    """
    return JOBS | ({NAME: learned_legs_job(legs)} if legs else {})


def claim_study(seeds: Sequence[int], legs: str = "") -> Study[ClaimTrial]:
    """Return the study of all claims: a run per seed, or one if not seeded.

    Args:
        seeds: Seeds of the physical runs. Cases are ordered by seed, so that
            an interrupted campaign has complete seeds.
        legs: As of :func:`jobs_of`.

    Raises:
        ConfigurationError: If the description of the robot names no policy.
    """
    trials = [
        ClaimTrial(name, seed, legs if name == NAME else "")
        for name, job in jobs_of(legs).items()
        for seed in (seeds if job.seeded else (0,))
    ]
    return Study(
        "claims",
        sorted(trials, key=lambda trial: trial.seed),
        run_trial,
        key_of,
        stamp_of,
        ("readings",),
    )


def key_of(trial: ClaimTrial) -> str:
    """Return the key of a run: its job, its seed and its settings."""
    job = _job_of(trial)
    inputs = [
        job.settings(trial.seed),
        sorted(claim.key for claim in job.claims),
    ]
    digest = sha256(json.dumps(inputs).encode()).hexdigest()[:12]
    return f"{trial.job}/{trial.seed}/{digest}"


def stamp_of(trial: ClaimTrial) -> CodeStamp:
    """Return the present versions on which the readings of a run depend."""
    job = _job_of(trial)
    return code_stamp(job.modules, job.libraries)


def _job_of(trial: ClaimTrial) -> ClaimJob:
    return learned_legs_job(trial.legs) if trial.legs else JOBS[trial.job]


def run_trial(trial: ClaimTrial) -> Record:
    """Measure the claims of a job once; NaN and inf become null."""
    found = _job_of(trial).measure(trial.seed)
    return {
        "readings": {
            name: value if isfinite(value) else None
            for name, value in found.items()
        }
    }


def claim_rows(run: StudyRun[ClaimTrial]) -> list[dict[str, Any]]:
    """Return one row per claim from a completed run, as JSON objects."""
    readings: dict[str, list[dict[str, float]]] = {}
    trials: dict[str, ClaimTrial] = {}
    for trial, record in run.items():
        trials[trial.job] = trial
        readings.setdefault(trial.job, [])
        readings[trial.job].append(
            {
                name: nan if value is None else float(value)
                for name, value in record["readings"].items()
            }
        )
    rows: list[ClaimRow] = []
    for name in (*JOBS, NAME):
        if name in trials:
            version = stamp_of(trials[name]).version
            job = _job_of(trials[name])
            rows += job.rows(name, readings[name], version)
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


def provenance(seed: int, legs: str = "") -> dict[str, dict[str, Any]]:
    """Return version, libraries and settings of each job, for one seed."""
    return {
        name: {
            "version": code_version(job.modules),
            "libraries": library_versions(job.libraries),
            "settings": job.settings(seed if job.seeded else 0),
        }
        for name, job in jobs_of(legs).items()
    }
