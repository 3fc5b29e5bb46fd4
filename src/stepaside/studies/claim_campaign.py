"""Campaign that measures every claim of the paper over many runs."""

import json
from collections.abc import Sequence
from hashlib import sha256
from math import isfinite, nan
from typing import Any, NamedTuple

from .claim_jobs import JOBS
from .claims import ClaimJob, ClaimRow
from .legs_claims import NAME, learned_legs_job
from .study import Study, StudyRun
from .tabulation import Record


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


def _job_of(trial: ClaimTrial) -> ClaimJob:
    return learned_legs_job(trial.legs) if trial.legs else JOBS[trial.job]


def run_trial(trial: ClaimTrial) -> Record:
    """Measure the claims of a job once; NaN and inf become null."""
    found = _job_of(trial).measure(trial.seed)
    return {
        name: value if isfinite(value) else None
        for name, value in found.items()
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
                for name, value in record.items()
            }
        )
    rows: list[ClaimRow] = []
    for name in (*JOBS, NAME):
        if name in trials:
            rows += _job_of(trials[name]).rows(name, readings[name])
    return [row.to_json() for row in rows]


def settings_of_jobs(seed: int, legs: str = "") -> dict[str, str]:
    """Return the settings of each job, for one seed."""
    return {
        name: job.settings(seed if job.seeded else 0)
        for name, job in jobs_of(legs).items()
    }
