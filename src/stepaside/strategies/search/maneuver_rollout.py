"""Rollout of one maneuver, with its score."""

from math import atan2, pi
from typing import Any, NamedTuple

from ...core.compilation import compiled, inlined
from .candidate_maneuvers import CandidateManeuvers, ManeuverObjective
from .distance_field import DistanceField, field_clearance
from .step_motion import PlayerPair, StepRules, half_turn, step_both
from .value_lookup import PursuitValues, value_at


class SearchProblem(NamedTuple):
    """Candidates, objective and rules of a search.

    Attributes:
        maneuvers: Candidate maneuvers.
        objective: Objective that ranks them.
        rules: Rules of a step.
        spot_rules: Rules of a step on the spot.
        field: Distance from obstacles.
        table: Value table after the horizon.
    """

    maneuvers: CandidateManeuvers
    objective: ManeuverObjective
    rules: StepRules
    spot_rules: StepRules
    field: DistanceField
    table: PursuitValues


@inlined
def judge(
    both: PlayerPair,
    score: float,
    objective: ManeuverObjective,
    field: DistanceField,
) -> float:
    """Return the score after one more step, given the score before it."""
    dx, dy = both.px - both.ex, both.py - both.ey
    reward = min((dx * dx + dy * dy) ** 0.5, objective.enough)
    if reward < score:
        score = reward
    missing = objective.clearance - field_clearance(field, both.ex, both.ey)
    if objective.sight < pi:
        psi = abs(
            atan2(both.ec * dy - both.es * dx, both.ec * dx + both.es * dy)
        )
        if psi > objective.sight:
            beyond = psi - objective.sight
            score = min(score, reward - objective.blindness * beyond)
    if missing > 0.0:
        score = min(score, reward - objective.penalty * missing)
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
    given: int,
    spot: int,
    worst: float,
    problem: SearchProblem,
) -> tuple[float, int]:
    """Roll out a maneuver: given turns, then the law.

    Args:
        both: Initial state of both players.
        score: Score so far.
        turns: Turn of each step; those of the law are filled in. Shape
            (steps,).
        given: Number of given turns.
        spot: Number of initial steps on the spot.
        worst: Score at or below which the rollout is aborted.
        problem: Maneuvers, objective and rules.

    Returns:
        Score, and number of steps rolled out.
    """
    rules, objective = problem.rules, problem.objective
    field, spot_rules = problem.field, problem.spot_rules
    angle, table = problem.maneuvers.angle, problem.table
    side = 0.0
    for n in range(len(turns)):
        if n >= given:
            if side == 0.0:
                dx, dy = both.px - both.ex, both.py - both.ey
                left = both.ec * dy - both.es * dx
                side = -1.0 if left > 0.0 else 1.0
            turns[n] = law_turn(both, side, angle, rules.evader_share)
        c, s, ratio = half_turn(0.5 * turns[n])
        if n < spot:
            both = step_both(both, c, s, ratio, spot_rules)
        else:
            both = step_both(both, c, s, ratio, rules)
        score = judge(both, score, objective, field)
        if score <= worst:
            return score, n + 1
    if table.values.shape[0] > 0:
        score = min(score, min(value_at(table, both), objective.enough))
    return score, len(turns)
