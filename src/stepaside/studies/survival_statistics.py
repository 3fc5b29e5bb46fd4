"""Survival statistics of a robustness campaign, and bounds on pushes."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cache
from math import radians
from typing import Any

import numpy as np

from ..games.walk_settings import WalkSettings
from ..planning import Direction, Foot, ManeuverPlanner
from ..planning.push_bound import FootReach, push_bound
from ..planning.steady_gait import steady_plan
from .push_limits import limit_of, outcomes_of
from .robustness_trial import (
    DIRECTIONS,
    STRENGTHS,
    RobustnessTrial,
    mass_of,
    push_scale,
    walk_of,
)
from .tabulation import Record, wilson_interval

PUSH = 0.1  # duration of a push, in [s]
DEFAULT = WalkSettings()


def survival_rows(
    results: Iterable[tuple[RobustnessTrial, Record]],
) -> list[dict[str, Any]]:
    """Tabulate survival by method, kind, direction and strength.

    Args:
        results: Finished trials and their records.
    """
    groups: dict[tuple[str, str, str, float], list[bool]] = defaultdict(list)
    for trial, record in results:
        group = trial.method, trial.kind, trial.direction, trial.strength
        groups[group].append(record["survived"])
    return [_survival_row(*group, groups[group]) for group in groups]


def push_survival_rows(
    limits: Sequence[dict[str, Any]], scale: float = 1.0
) -> list[dict[str, Any]]:
    """Tabulate the number of phases at which each push is survived.

    Args:
        limits: Rows of :func:`limit_rows`.
        scale: Factor on the strengths for another robot than NAO; see
            :func:`~.robustness_trial.push_scale`.
    """
    groups: dict[tuple[str, str], list[float]] = defaultdict(list)
    for row in limits:
        groups[row["method"], row["direction"]].append(row["limit_n_s"])
    return [
        _survival_row(
            method,
            "push",
            direction,
            scale * strength,
            # The tolerance is for rounding of the limits.
            [x >= (scale - 1e-9) * strength for x in found],
        )
        for (method, direction), found in groups.items()
        for strength in STRENGTHS["push"]
    ]


def _survival_row(
    method: str,
    kind: str,
    direction: str,
    strength: float,
    outcomes: Sequence[bool],
) -> dict[str, Any]:
    low, high = wilson_interval(sum(outcomes), len(outcomes))
    return {
        "method": method,
        "kind": kind,
        "direction": direction,
        "strength": strength,
        "survived": sum(outcomes),
        "trials": len(outcomes),
        "low": low,
        "high": high,
    }


def limit_rows(
    results: Iterable[tuple[RobustnessTrial, Record]],
) -> list[dict[str, Any]]:
    """Tabulate the largest survived pushes with their bounds.

    Args:
        results: Push cases and the records of their searches.
    """
    rows = []
    for case, record in results:
        walk = walk_of(case)
        limit = limit_of(outcomes_of(record)) * push_scale(walk.robot)
        bound = push_bound_at(case.direction, case.phase, walk)
        rows.append(
            {
                "method": case.method,
                "direction": case.direction,
                "phase": case.phase,
                "limit_n_s": limit,
                "bound_n_s": bound,
                "impulse_bound_n_s": push_bound_at(
                    case.direction, case.phase, walk, impulse=True
                ),
                "limit_m_s": limit / mass_of(walk.robot),
                "ratio": limit / bound,
            }
        )
    return rows


@cache
def push_bound_at(
    direction: str,
    phase: float,
    walk: WalkSettings = DEFAULT,
    *,
    impulse: bool = False,
) -> float:
    """Return the push bound of the linear inverted pendulum, in [N s].

    The walk is in its steady gait cycle when it is pushed.

    Args:
        direction: Direction of the push, a key of ``DIRECTIONS``.
        phase: Phase at which the push begins, as a fraction of the gait
            cycle.
        walk: Robot, gait, heading and reach; a straight walk by default.
        impulse: Whether to replace the push by an impulse at its middle.
            That does not bound the push, during whose first half the ZMP
            can already react.
    """
    gait = walk.gait
    cycle = 2.0 * gait.step_duration
    lasts = 0.0 if impulse else PUSH
    passed = (phase * cycle + (0.5 * PUSH if impulse else 0.0)) % cycle
    foot = Foot.LEFT if passed < gait.step_duration else Foot.RIGHT
    plan = steady_plan(
        ManeuverPlanner(gait),
        walk.bearing,
        Direction.BACKWARD if walk.backward else Direction.FORWARD,
        first_foot=foot,
    )
    passed %= gait.step_duration
    angle, reach = radians(DIRECTIONS[direction]), foot_reach(walk)
    mass = mass_of(walk.robot)
    return push_bound(plan, passed, angle, mass, reach, lasts=lasts)


def foot_reach(walk: WalkSettings = DEFAULT) -> FootReach:
    """Return the foot placements that the feedback of a walk allows."""
    gains = walk.control.stabiliser
    return FootReach(
        gains.reach_forward,
        gains.reach_backward,
        gains.reach_outward,
        gains.gap,
    )


def summarise_limits(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Summarise the ratios of limit to bound by method."""
    methods = dict.fromkeys(row["method"] for row in rows)
    summary = {}
    for method in methods:
        own = [row for row in rows if row["method"] == method]
        ratios = [row["ratio"] for row in own]
        impulse = [row["limit_n_s"] / row["impulse_bound_n_s"] for row in own]
        summary[method] = {
            "cases": len(own),
            "median_of_bound": float(np.median(ratios)),
            "least_of_bound": float(min(ratios)),
            "most_of_bound": float(max(ratios)),
            "above_bound": sum(ratio > 1.0 for ratio in ratios),
            "median_of_impulse_bound": float(np.median(impulse)),
            "least_of_impulse_bound": float(min(impulse)),
            "above_impulse_bound": sum(ratio > 1.0 for ratio in impulse),
            "least_n_s": min(row["limit_n_s"] for row in own),
        }
    return summary
