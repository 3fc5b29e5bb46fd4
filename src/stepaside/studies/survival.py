"""Survival of a campaign, with confidence, beside the pendulum's bound."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from math import radians, sqrt
from typing import Any

import numpy as np

from ..control.settings import StabiliserSettings
from ..planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
)
from ..planning.capture import Reach, push_bound
from ..robots.description import load_robot
from ..robots.forward import ForwardKinematics
from .robustness import DIRECTIONS, Trial

CONFIDENCE = 1.96  # standard deviations of a 95 % interval
PUSH = 0.1  # duration of a push, in [s]


def wilson(survived: int, number: int) -> tuple[float, float]:
    """95 % confidence interval of a share, after Wilson (1927)."""
    if number == 0:
        return 0.0, 1.0
    z, n = CONFIDENCE, number
    share = survived / n
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n)
    half *= sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    return max(0.0, middle - half), min(1.0, middle + half)


def survival_rows(
    grid: Sequence[Trial], results: Mapping[str, bool]
) -> list[dict[str, Any]]:
    """Share of survivors for each method, kind, direction and strength."""
    groups: dict[tuple[str, str, str, float], list[bool]] = defaultdict(list)
    for trial in grid:
        if trial.key in results:
            group = trial.method, trial.kind, trial.direction, trial.strength
            groups[group].append(results[trial.key])
    rows = []
    for (method, kind, direction, strength), outcomes in groups.items():
        low, high = wilson(sum(outcomes), len(outcomes))
        rows.append(
            {
                "method": method,
                "kind": kind,
                "direction": direction,
                "strength": strength,
                "survived": sum(outcomes),
                "trials": len(outcomes),
                "low": low,
                "high": high,
            }
        )
    return rows


def limit_rows(
    grid: Sequence[Trial], results: Mapping[str, bool]
) -> list[dict[str, Any]]:
    """Largest push survived with all smaller ones, beside the bound."""
    groups: dict[tuple[str, str, float], dict[float, bool]] = defaultdict(dict)
    for trial in grid:
        if trial.kind == "push" and trial.key in results:
            group = trial.method, trial.direction, trial.phase
            groups[group][trial.strength] = results[trial.key]
    rows = []
    for (method, direction, phase), outcomes in groups.items():
        limit = 0.0
        for strength in sorted(outcomes):
            if not outcomes[strength]:
                break
            limit = strength
        bound = bound_at(direction, phase)
        rows.append(
            {
                "method": method,
                "direction": direction,
                "phase": phase,
                "limit_n_s": limit,
                "bound_n_s": bound,
                "ratio": limit / bound,
            }
        )
    return rows


def bound_at(direction: str, phase: float) -> float:
    """Bound of the pendulum at a phase of a straight walk, in [N s].

    A push of 0.1 s counts as an impulse at its middle.
    """
    gait = GaitSettings()
    cycle = 2.0 * gait.step_duration
    passed = (phase * cycle + 0.5 * PUSH) % cycle
    foot = Foot.LEFT if passed < gait.step_duration else Foot.RIGHT
    passed %= gait.step_duration
    state = CenterState((0.0, 0.0), (0.0, 0.0))
    plan = ManeuverPlanner(gait).plan(
        0.0, Direction.FORWARD, first_foot=foot, state=state
    )
    gains = StabiliserSettings()
    reach = Reach(
        gains.reach_forward,
        gains.reach_backward,
        gains.reach_outward,
        gains.gap,
    )
    mass = ForwardKinematics(load_robot("nao")).mass
    angle = radians(DIRECTIONS[direction])
    return push_bound(plan, passed, angle, mass, reach)


def summarise_limits(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Median and least ratio of limit to bound, by method."""
    methods = dict.fromkeys(row["method"] for row in rows)
    summary = {}
    for method in methods:
        ratios = [r["ratio"] for r in rows if r["method"] == method]
        summary[method] = {
            "median_of_bound": float(np.median(ratios)),
            "least_of_bound": float(min(ratios)),
        }
    return summary
