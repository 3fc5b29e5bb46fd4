"""Results of a tournament: one row per pairing."""

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np

from ..strategies.strategy_game import StepGame
from ..theory.unicycle.circles import find_circle
from .tabulation import half_interval, wilson_interval
from .tournament_strategies import gain_of

Record = dict[str, Any]


def tournament_rows(
    records: Sequence[Record], game: StepGame | None = None
) -> list[Record]:
    """Tabulate the records of a tournament, as values for JSON.

    Args:
        records: Records of
            :func:`~stepaside.studies.tournament_record.play_record`.
        game: Rules of the games.

    Returns:
        For each pairing: proportions with 95 % intervals after Wilson, means
        with 95 % intervals, the seeds of the worst games, the capture
        distance, and the distance on the
        paper's circle.
    """
    game = game or StepGame()
    pairings = dict.fromkeys((r["evader"], r["pursuer"]) for r in records)
    return [
        _row([r for r in records if (r["evader"], r["pursuer"]) == pairing])
        | {
            "capture_distance_m": game.capture,
            "circle_distance_m": circle_distance(game, pairing[1]),
        }
        for pairing in pairings
    ]


def circle_distance(game: StepGame, pursuer: str) -> float | None:
    """Return the distance on the paper's circle for a pursuer.

    The evader moves aside, with the gain of the game. If this distance is at
    most the capture distance, it is captured.

    Args:
        game: Rules of the games.
        pursuer: Name of the pursuer in a tournament.

    Returns:
        Distance, in [m]; None for a pursuer that does not steer by eq. (2),
        or of another speed.
    """
    ratio = gain_of(pursuer)
    if ratio is None or game.pursuer_speed_ratio != 1.0:
        return None
    circle = find_circle(
        game.speed,
        game.speed,
        ratio * game.gain,
        game.gain,
        0.5 * pi,
        "proportional",
    )
    return float(circle.distance_m) if circle.exists else None


def _row(records: Sequence[Record]) -> Record:
    outcomes = [r["outcome"] for r in records]
    survived = outcomes.count("survived")
    low, high = wilson_interval(survived, len(records))
    closest = np.array([r["closest_m"] for r in records])
    bound = np.array([r["bound_m"] for r in records])
    decisions = 1e3 * np.array([r["decision_s"] for r in records])
    # Worst first: lost games by survival time, then survived games by
    # closest approach.
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
        "captured": outcomes.count("captured") / len(records),
        "contact": _contact_proportion(records),
        "touched_obstacle": outcomes.count("touched") / len(records),
        "fell": outcomes.count("fell") / len(records),
        "mean_survival_s": float(np.mean([r["survived_s"] for r in records])),
        "mean_closest_m": float(closest.mean()),
        "mean_closest_pm_m": half_interval(closest),
        "mean_bound_m": float(bound.mean()),
        "closest_over_bound": float(closest.mean() / bound.mean()),
        "floor_used_m2": float(np.mean([r["floor_m2"] for r in records])),
        "floor_used_pm_m2": half_interval(
            np.array([r["floor_m2"] for r in records])
        ),
        "turning_rad_s": float(np.mean([r["turning_rad_s"] for r in records])),
        "out_of_view": float(np.mean([r["unseen"] for r in records])),
        "decision_ms": float(decisions.mean()),
        "longest_decision_ms": 1e3
        * float(max(r["longest_decision_s"] for r in records)),
        "worst_seeds": [r["seed"] for r in order[:5]],
    }


def _contact_proportion(records: Sequence[Record]) -> float | None:
    """Return the proportion of games with contact; None without physics."""
    if any("contact" not in r for r in records):
        return None
    return [r["contact"] for r in records].count(True) / len(records)
