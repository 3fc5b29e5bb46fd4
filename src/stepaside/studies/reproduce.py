"""Every claim of the paper beside its measurement, job by job."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import physics_claims, planner_claims, unicycle_claims
from .claims import Row

Job = Callable[[int], list[Row]]
JOBS: dict[str, Job] = {
    "circle": lambda _: unicycle_claims.circle_rows(),
    "saturated": lambda _: unicycle_claims.saturated_rows(),
    "strategies": lambda _: unicycle_claims.strategy_rows(),
    "sampled": lambda _: unicycle_claims.sampled_rows(),
    "path": lambda _: planner_claims.path_rows(),
    "footsteps": lambda _: planner_claims.footstep_rows(),
    "com": lambda _: planner_claims.com_rows(),
    "humanoids": physics_claims.circle_rows,
    "durations": physics_claims.duration_rows,
    "slip": physics_claims.slip_rows,
}


def reproduce(
    folder: Path | None,
    seed: int,
    report: Callable[[str], None] | None = None,
) -> list[dict[str, Any]]:
    """Measure every claim; what a folder holds already is kept.

    Args:
        folder: Where each job's rows are kept as they come, so that an
            interrupted run goes on where it stopped; None keeps nothing.
        seed: Seed of the duels.
        report: Called with the name of each job when it is done.

    Returns:
        Rows, as JSON objects.
    """
    rows: list[dict[str, Any]] = []
    for name, job in JOBS.items():
        kept = None if folder is None else folder / f"{name}-seed{seed}.json"
        if kept is not None and kept.exists():
            found = json.loads(kept.read_text(encoding="utf-8"))
        else:
            found = [row.to_json() for row in job(seed)]
            if kept is not None:
                kept.parent.mkdir(parents=True, exist_ok=True)
                draft = kept.with_suffix(".part")
                draft.write_text(json.dumps(found), encoding="utf-8")
                draft.rename(kept)
        rows += found
        if report is not None:
            report(name)
    return rows
