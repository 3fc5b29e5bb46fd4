"""Claims of the paper: their texts, measurements and verdicts."""

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from math import isfinite, nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..locomotion.policy.velocity_response import digest_of
from . import game_claims as games
from . import theory_claims as theory
from .study import Study, StudyRun
from .tabulation import Record

FILE = Path(__file__).with_suffix(".toml")
RUN_FACTOR = 2.0  # tolerance of a single run over that of the mean
LEGS = "learned-legs"  # job on the learned legs of a robot

Readings = dict[str, float]
ONCE: dict[str, Callable[[], Readings]] = {
    "circle": theory.read_circle,
    "saturated": theory.read_saturated,
    "strategies": theory.read_strategies,
    "sampled": theory.read_sampled,
    "path": theory.read_path,
    "footsteps": theory.read_footsteps,
    "com": theory.read_com,
    "timing": theory.read_timing,
}
"""Jobs that need one run; each measures a reading for each of its claims."""
SEEDED: dict[str, Callable[[int], Readings]] = {
    "humanoids": games.measure_humanoids,
    "durations": games.measure_durations,
    "slip": games.measure_slip,
    "evading": games.measure_evading,
    "rooms": games.measure_room,
}
"""Jobs with random initial poses, by a seed."""


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim or number of the paper; an entry of ``claims.toml``."""

    claim: str  # claim of the paper, corrected where necessary
    section: str  # section or figure of the paper
    # level at which it is measured: closed form, unicycle, sampled, planner,
    # steps or physics
    level: str
    expected: float  # expected value
    unit: str  # unit of the values
    tolerance: float = 0.0  # zero for an inequality
    # "=", "<" or ">": how measured values must compare with the expected one
    relation: str = "="
    as_printed: str | None = None  # the printed text, where it differs

    def holds(self, values: Sequence[float]) -> bool:
        """Return whether the runs confirm the claim.

        Every run must have a finite value. An inequality must hold in every
        run. For an equality the mean must be within the tolerance, and every
        single run within twice the tolerance.
        """
        if not values or not all(isfinite(value) for value in values):
            return False
        differences = np.asarray(values) - self.expected
        if self.relation == "<":
            return bool((differences < 0.0).all())
        if self.relation == ">":
            return bool((differences > 0.0).all())
        return bool(
            abs(np.mean(values) - self.expected) <= self.tolerance
            and (np.abs(differences) <= RUN_FACTOR * self.tolerance).all()
        )

    def row(self, name: str, values: Sequence[float]) -> dict[str, Any]:
        """Return claim and measured values as a JSON object."""
        finite = [value for value in values if isfinite(value)]
        whole = bool(values) and len(finite) == len(values)
        spread = float(np.std(values, ddof=1)) if len(finite) > 1 else 0.0
        return {
            "name": name,
            **asdict(self),
            "measured": float(np.mean(values)) if whole else None,
            "spread": spread if whole else None,
            "least": min(finite, default=None),
            "greatest": max(finite, default=None),
            "runs": len(values),
            "verdict": "holds" if self.holds(values) else "fails",
        }


@cache
def load_claims() -> dict[str, dict[str, Claim]]:
    """Return all claims, by job and key of the reading."""
    jobs = tomllib.loads(FILE.read_text(encoding="utf-8"))
    found: dict[str, dict[str, Claim]] = {}
    for job, entries in jobs.items():
        shared = {k: v for k, v in entries.items() if isinstance(v, str)}
        found[job] = {
            key: Claim(**(shared | entry))
            for key, entry in entries.items()
            if key not in shared
        }
    return found


class ClaimTrial(NamedTuple):
    """One run of a job."""

    job: str  # name of the job
    seed: int = 0  # seed of the run; 0 where it does not matter
    legs: str = ""  # folder of the robot whose learned legs the job measures


def claim_study(seeds: Sequence[int], legs: str = "") -> Study[ClaimTrial]:
    """Return the study of all claims, by seeds of games from random poses.

    Without seeds only what needs one run is measured. Cases are ordered by
    seed, so that an interrupted study has complete seeds. With the folder of a
    robot whose description names a walking policy the paper's game is measured
    on its legs, too.
    """
    jobs = [*SEEDED, *([LEGS] if legs else [])]
    trials = [ClaimTrial(job) for job in ONCE]
    for seed in seeds:
        trials += [
            ClaimTrial(job, seed, legs if job == LEGS else "") for job in jobs
        ]
    network = ""
    if legs:
        own = games.legs_settings(legs, 0).evader.legs
        network = f"/{digest_of(Path(own.network))}"

    def key_of(trial: ClaimTrial) -> str:
        return f"{trial.job}/{trial.seed}{network if trial.legs else ''}"

    return Study("claims", trials, run_trial, key_of)


def run_trial(trial: ClaimTrial) -> Record:
    """Measure the claims of a job once; NaN and inf become null."""
    job, seed, legs = trial
    if legs:
        found = games.measure_legs(legs, seed)
    else:
        found = ONCE[job]() if job in ONCE else SEEDED[job](seed)
    return {
        key: found[key] if isfinite(found[key]) else None
        for key in load_claims()[job]
    }


def claim_rows(run: StudyRun[ClaimTrial]) -> list[dict[str, Any]]:
    """Return one row per claim from a completed run, as JSON objects."""
    readings: dict[str, list[Mapping[str, Any]]] = {}
    for trial, record in run.items():
        readings.setdefault(trial.job, []).append(record)
    return [
        claim.row(
            f"{job}.{key}",
            [nan if r[key] is None else float(r[key]) for r in readings[job]],
        )
        for job, claims in load_claims().items()
        if job in readings
        for key, claim in claims.items()
    ]
