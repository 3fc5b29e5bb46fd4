"""Rollout of an evader's moves against a model of the pursuer, and its score.

The score is the least distance to the pursuer, less penalties, and never
increases along a rollout: so that is left as soon as it is no better than
the best so far.
"""

from math import inf, pi, sqrt
from typing import Any, NamedTuple

from ...arena.obstacles import PackedObstacles, clearance_at
from ...core.compilation import compiled, inlined
from ..knowledge import ON_THE_SPOT
from .step_motion import (
    PlayerPair,
    PursuerModel,
    StepRules,
    evader_bearing,
    evasion_heading,
    step_both,
    update_side,
)

ENOUGH = 0.8  # distance beyond which no more is gained, in [m]
SLOW = 2.0 * ON_THE_SPOT  # speed factor of a turn on the spot, or less
ON_SPOT_SLACK = 0.004  # of clearance that turns on the spot may use, in [m]
LEAVING = 0.002  # clearance that an evader gains that leaves an obstacle, in
# [m]; an arc bulges by 0.0013


class Objective(NamedTuple):
    """Score of a step; -inf once the game is lost."""

    rules: StepRules
    packed: PackedObstacles
    clearance: float  # that the own centre requires [m]
    enough: float = ENOUGH  # distance beyond which no more is gained [m]
    capture: float = 0.0  # distance at which the game is lost [m]
    # of missing clearance, in [m] per [m]; infinite: the game is lost
    penalty: float = inf
    # cost of a bearing beyond sight, in [m] per [rad], and sight [rad]
    blindness: float = 0.0
    sight: float = pi


@inlined
def required(near: float, pace: float) -> float:
    """Return what a step must keep of the clearance beyond the required, [m].

    An evader that is too near to an obstacle may turn on the spot, or leave.
    """
    turning = -ON_SPOT_SLACK
    if abs(pace) <= SLOW:
        return min(near, turning)
    return min(near + LEAVING, 0.0) if near < turning else 0.0


@inlined
def judge(
    both: PlayerPair,
    score: float,
    least: float,
    reach: float,
    objective: Objective,
) -> tuple[float, float, float]:
    """Return the score after one more step, the distance and the clearance.

    The clearance, in [m], is that beyond the required; it must be ``least``,
    and is known up to ``reach``.
    """
    dx, dy = both.px - both.ex, both.py - both.ey
    away = sqrt(dx * dx + dy * dy)
    if away <= objective.capture:
        return -inf, away, 0.0
    reward = min(away, objective.enough)
    score = min(score, reward)
    enough = objective.clearance + reach
    clear = clearance_at(objective.packed, both.ex, both.ey, enough)
    clear -= objective.clearance
    if objective.blindness > 0.0:
        unseen = abs(evader_bearing(both)) - objective.sight
        if unseen > 0.0:
            score = min(score, reward - objective.blindness * unseen)
    if clear < least:
        score = min(score, reward - objective.penalty * (least - clear))
    return score, away, clear


@compiled
def roll_out(
    both: PlayerPair,
    score: float,
    moves: Any,
    given: int,
    worst: float,
    model: PursuerModel,
    objective: Objective,
) -> tuple[PlayerPair, float, int]:
    """Roll out given moves, then the law of Sec. II-B.

    Moves are turn [rad] and speed factor of each step, (n, 2); those of the
    law are written. Returns state and score after the steps before the score
    would be no better than the worst, and their number.
    """
    rules, side, least = objective.rules, 0, 0.0
    for n in range(len(moves)):
        if n >= given:
            psi = evader_bearing(both)
            side = update_side(side, psi, pi)
            moves[n, 0] = rules.share * evasion_heading(psi, side, 0.5 * pi)
            moves[n, 1] = 1.0
        if objective.penalty == inf:
            near = clearance_at(
                objective.packed, both.ex, both.ey, objective.clearance
            )
            least = required(near - objective.clearance, moves[n, 1])
        after = step_both(both, moves[n, 0], moves[n, 1], model, rules)
        later, _, _ = judge(after, score, least, 0.0, objective)
        if later <= worst:
            return both, score, n
        both, score = after, later
    return both, score, len(moves)
