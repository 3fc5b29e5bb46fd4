"""What came out of a tournament: a row for each pairing."""

from collections.abc import Sequence
from math import sqrt
from typing import Any

import numpy as np

from .survival import wilson

Record = dict[str, Any]
NORMAL = 1.959964  # standard deviations of a 95 % interval


def tournament_rows(records: Sequence[Record]) -> list[Record]:
    """Rows of a tournament, ready for JSON.

    Args:
        records: Of :func:`~stepaside.studies.tournament.play_record`.

    Returns:
        For each pairing: shares with 95 % intervals after Wilson, means with
        95 % intervals, and the seeds of the games that came worst.
    """
    pairings = dict.fromkeys((r["evader"], r["pursuer"]) for r in records)
    return [
        _row([r for r in records if (r["evader"], r["pursuer"]) == pairing])
        for pairing in pairings
    ]


def _row(records: Sequence[Record]) -> Record:
    outcomes = [r["outcome"] for r in records]
    survived = outcomes.count("survived")
    low, high = wilson(survived, len(records))
    closest = np.array([r["closest_m"] for r in records])
    bound = np.array([r["bound_m"] for r in records])
    decisions = 1e3 * np.array([r["decision_s"] for r in records])
    # Who survived is worse the nearer the pursuer came, and better than who
    # did not, which is worse the sooner it ended.
    order = sorted(
        records,
        key=lambda r: (
            (1, r["closest_m"])
            if r["outcome"] == "survived"
            else (0, r["survived_s"])
        ),
    )
    return {
        "evader": records[0]["evader"],
        "pursuer": records[0]["pursuer"],
        "games": len(records),
        "survived": survived / len(records),
        "survived_low": low,
        "survived_high": high,
        "caught": outcomes.count("caught") / len(records),
        "touched_obstacle": outcomes.count("touched") / len(records),
        "fell": outcomes.count("fell") / len(records),
        "mean_survival_s": float(np.mean([r["survived_s"] for r in records])),
        "mean_closest_m": float(closest.mean()),
        "mean_closest_pm_m": _half(closest),
        "mean_bound_m": float(bound.mean()),
        "closest_over_bound": float(closest.mean() / bound.mean()),
        "floor_used_m2": float(np.mean([r["floor_m2"] for r in records])),
        "floor_used_pm_m2": _half(np.array([r["floor_m2"] for r in records])),
        "turning_rad_s": float(np.mean([r["turning_rad_s"] for r in records])),
        "out_of_view": float(np.mean([r["unseen"] for r in records])),
        "decision_ms": float(decisions.mean()),
        "longest_decision_ms": 1e3
        * float(max(r["longest_decision_s"] for r in records)),
        "worst_seeds": [r["seed"] for r in order[:5]],
    }


def _half(values: Any) -> float:
    """Half of the 95 % interval of a mean."""
    if len(values) < 2:
        return 0.0
    return NORMAL * float(values.std(ddof=1)) / sqrt(len(values))
