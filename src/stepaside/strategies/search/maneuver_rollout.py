"""Rollout of one maneuver, with its score."""

from math import atan2, pi
from pathlib import Path
from typing import Any

from ...arena.obstacles import PackedObstacles
from ...theory.unicycle.compilation import (
    compiled,
    forget_stale,
    inlined,
    load_numba,
)
from .candidate_maneuvers import ManeuverObjective
from .packed_obstacles import clearance_at
from .step_motion import PlayerPair, StepRules, half_turn, step_both
from .value_lookup import ValueTable, value_at

if load_numba() is not None:
    _HERE = Path(__file__).parent
    _UNICYCLE = _HERE.parents[1] / "theory" / "unicycle"
    forget_stale(_HERE, [*_HERE.glob("*.py"), *_UNICYCLE.glob("*.py")])


@inlined
def judge(
    both: PlayerPair,
    score: float,
    aims: ManeuverObjective,
    packed: PackedObstacles,
) -> float:
    """Return the score after one more step, given the score before it."""
    dx, dy = both.px - both.ex, both.py - both.ey
    reward = min((dx * dx + dy * dy) ** 0.5, aims.enough)
    if reward < score:
        score = reward
    missing = aims.clearance - clearance_at(
        packed, both.ex, both.ey, aims.clearance
    )
    if aims.sight < pi:
        psi = abs(
            atan2(both.ec * dy - both.es * dx, both.ec * dx + both.es * dy)
        )
        if psi > aims.sight:
            score = min(score, reward - aims.blindness * (psi - aims.sight))
    if missing > 0.0:
        score = min(score, reward - aims.penalty * missing)
    return score


@inlined
def law_turn(
    both: PlayerPair, side: float, angle: float, share: float
) -> float:
    """Return the turn of a step by eqs. (4)-(5), in [rad]."""
    dx, dy = both.px - both.ex, both.py - both.ey
    psi = atan2(both.ec * dy - both.es * dx, both.ec * dx + both.es * dy)
    heading = psi + side * angle
    if heading > pi:
        heading -= 2.0 * pi
    elif heading < -pi:
        heading += 2.0 * pi
    return share * heading


@compiled
def follow(
    both: PlayerPair,
    score: float,
    turns: Any,
    count: int,
    spot: int,
    still: StepRules,
    horizon: int,
    best: float,
    angle: float,
    rules: StepRules,
    aims: ManeuverObjective,
    packed: PackedObstacles,
    table: ValueTable,
) -> tuple[float, int]:
    """Roll out a maneuver: given turns, then the law.

    Args:
        both: Initial state of both players.
        score: Score so far.
        turns: Turn of each step; those of the law are appended in place.
        count: Number of given turns.
        spot: Number of initial steps on the spot.
        still: Rules of a step on the spot.
        horizon: Total number of steps.
        best: Score at or below which the rollout is aborted.
        angle: Strategy alpha of the law, in [rad].
        rules: Rules of a step.
        aims: Objective.
        packed: Obstacles.
        table: Value table after the horizon.

    Returns:
        Score, and number of steps rolled out.
    """
    side = 0.0
    for n in range(horizon):
        if n >= count:
            if side == 0.0:
                dx, dy = both.px - both.ex, both.py - both.ey
                left = both.ec * dy - both.es * dx
                side = -1.0 if left > 0.0 else 1.0
            turns[n] = law_turn(both, side, angle, rules.evader_share)
        c, s, ratio = half_turn(0.5 * turns[n])
        if n < spot:
            both = step_both(both, c, s, ratio, still)
        else:
            both = step_both(both, c, s, ratio, rules)
        score = judge(both, score, aims, packed)
        if score <= best:
            return score, n + 1
    if table.values.shape[0] > 0:
        score = min(score, min(value_at(table, both), aims.enough))
    return score, horizon
