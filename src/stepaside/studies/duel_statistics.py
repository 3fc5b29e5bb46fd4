"""Statistics of many duels: proportions, means and worst seeds."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..games.duel_circle import circle_of_theory
from ..games.duel_settings import DuelSettings
from .tabulation import Record, half_interval, wilson_interval

BEFORE = 2.0 / 3.0  # of a duel; means are taken over the rest
OUTCOMES = ("completed", "fall", "contact")  # reported even if there are none
# Value of a record, the theoretical value to compare with, and the worst end
# of its range: farthest from theory (0), largest (1), smallest (-1).
VALUES: dict[str, tuple[str | None, int]] = {
    "pursuer_radius_m": ("radius_m", 0),
    "evader_radius_m": ("radius_m", 0),
    "distance_m": ("distance_m", 0),
    "relative_orientation_deg": ("relative_orientation_deg", 0),
    "converged_at_s": (None, 1),
    "min_distance_m": (None, -1),
    "triggered_at_distance_m": (None, -1),
    "min_zmp_margin_m": (None, -1),
    "misled_s": (None, 1),
    "lost_s": (None, 1),
    "detection_rate": (None, -1),
    "false_detections": (None, 1),
}


def summarise_duels(
    settings: DuelSettings, records: Sequence[Record]
) -> dict[str, Any]:
    """Summarise many duels, as values for JSON.

    Outcomes and convergence are proportions with the 95 % interval after
    Wilson. A duel is on the circle if it stays on it for at least the last
    5 s, and in time if it converges before the last third (the rule of the
    claims page). Other values are those of completed duels, with the 95 %
    interval of their mean.

    Args:
        settings: Settings of the duels.
        records: Records of
            :func:`~stepaside.studies.duel_record.play_record`.
    """
    theory = _theory(settings)
    played = [r for r in records if r["outcome"] == "completed"]
    outcomes = dict.fromkeys([*OUTCOMES, *(r["outcome"] for r in records)])
    values = {}
    for name, (theory_name, bad) in VALUES.items():
        row = value_row(name, played, theory.get(theory_name or ""), bad)
        if row is not None:
            values[name] = row
    return {
        "duels": len(records),
        "outcomes": {
            name: proportion(r["outcome"] == name for r in records)
            for name in outcomes
        },
        "on_the_circle": proportion(
            r["converged_at_s"] is not None for r in records
        ),
        "on_the_circle_by_s": BEFORE * settings.duration,
        "on_the_circle_in_time": proportion(
            r["converged_at_s"] is not None
            and r["converged_at_s"] < BEFORE * settings.duration
            for r in records
        ),
        "theory": theory,
        "figures": values,
        "certificate": certificate_row(records),
        "not_completed": [
            {key: r[key] for key in ("seed", "outcome", "message")}
            for r in records
            if r["outcome"] != "completed"
        ],
        "not_on_the_circle": [
            r["seed"] for r in played if r["converged_at_s"] is None
        ],
    }


def proportion(hits: Iterable[bool]) -> dict[str, float]:
    """Return the number of hits and the 95 % interval of their proportion."""
    each = list(hits)
    low, high = wilson_interval(sum(each), len(each))
    return {"number": sum(each), "of": len(each), "low": low, "high": high}


def value_row(
    name: str, records: Sequence[Record], theory: float | None, bad: int
) -> dict[str, Any] | None:
    """Return mean, spread and worst seed of a value; None without records.

    Args:
        name: Key of a record.
        records: Records; those without the value are skipped.
        theory: Theoretical value, if there is one.
        bad: Worst end of the range; see ``VALUES``.
    """
    present = [r for r in records if r.get(name) is not None]
    if not present:
        return None
    values = np.array([r[name] for r in present], dtype=np.float64)
    badness = bad * values
    if bad == 0:
        middle = values.mean() if theory is None else theory
        badness = np.abs(values - middle)
    worst = int(np.argmax(badness))
    sigma = float(values.std(ddof=1)) if len(values) > 1 else 0.0
    half = half_interval(values)
    mean = float(values.mean())
    return {
        "number": len(values),
        "theory": theory,
        "mean": mean,
        "mean_low": mean - half,
        "mean_high": mean + half,
        "deviation": sigma,
        "least": float(values.min()),
        "median": float(np.median(values)),
        "greatest": float(values.max()),
        "worst": float(values[worst]),
        "worst_seed": int(present[worst]["seed"]),
    }


def certificate_row(records: Sequence[Record]) -> dict[str, Any]:
    """Compare closest approaches with the certificates of the template."""
    both = [
        r
        for r in records
        if r["certified_m"] is not None
        and r["evading_min_distance_m"] is not None
    ]
    over = [r["evading_min_distance_m"] - r["certified_m"] for r in both]
    nearest = int(np.argmin(over)) if over else None
    return {
        "certified": proportion(r["certified_m"] is not None for r in records),
        "nearer_than_certified": proportion(x < 0.0 for x in over),
        "least_excess_m": None if nearest is None else over[nearest],
        "median_excess_m": float(np.median(over)) if over else None,
        "worst_seed": None if nearest is None else both[nearest]["seed"],
    }


def _theory(settings: DuelSettings) -> dict[str, float]:
    circle = circle_of_theory(settings)
    if not circle.exists:
        return {}
    return {
        "radius_m": circle.radius_evader_m,
        "distance_m": circle.distance_m,
        "relative_orientation_deg": float(
            np.degrees(circle.headings_apart_rad)
        ),
    }
