"""Candidate maneuvers of look-ahead, and their rollout with a score."""

from math import atan2, inf, pi
from typing import Any, NamedTuple

from ...core.compilation import compiled, inlined
from .distance_field import DistanceField, field_clearance
from .step_motion import (
    PlayerPair,
    PursuerModel,
    StepRules,
    half_turn,
    step_both,
)
from .value_lookup import PursuitValues, value_at

DEEPEST = 8  # most pieces of a maneuver, plus one


class CandidateManeuvers(NamedTuple):
    """Set of maneuvers that the search tries.

    Attributes:
        pieces: Number of steps of each piece, in order. Shape (n,).
        turns: Turns per step that are tried in each piece, in [rad], the
            preferred ones first. Shape (m,).
        horizon: Number of steps of a maneuver, law included, without those
            on the spot.
        angle: Strategy alpha of the law, in [rad].
        spots: Largest number of steps that turn on the spot, by the largest
            turn, before the first piece; every second number is tried.
        still: Fraction of the stride that a step on the spot makes.
        most: Number of rolled-out steps after which no further maneuver is
            begun, which bounds the time of a decision.
    """

    pieces: Any
    turns: Any
    horizon: int
    angle: float = pi / 2
    spots: int = 0
    still: float = 0.05
    most: int = 40_000


class ManeuverObjective(NamedTuple):
    """Objective of the search.

    Attributes:
        enough: Distance to the pursuer beyond which no more is gained, [m].
        clearance: Required clearance of the own centre, in [m].
        penalty: Cost of missing clearance, in [m] per [m].
        sight: Largest bearing at which the pursuer is visible, in [rad].
        blindness: Cost of a bearing beyond that, in [m] per [rad].
        gain: Improvement over the present maneuver that replaces it, in [m].
        tight: Score below which turns on the spot are tried as well, [m].
    """

    enough: float = inf
    clearance: float = 0.2
    penalty: float = 5.0
    sight: float = inf
    blindness: float = 0.1
    gain: float = 1e-6
    tight: float = -inf


class BestManeuver(NamedTuple):
    """Result of the search.

    Attributes:
        score: Score of the maneuver, in [m].
        turns: Turn of each of its steps, in [rad], those of the law
            included. Shape (horizon + spot,).
        steps: Number of steps that the search rolled out.
        spot: Number of initial steps that turn on the spot.
    """

    score: float
    turns: Any
    steps: int
    spot: int = 0


class SearchProblem(NamedTuple):
    """Candidates, objective and rules of a search.

    Attributes:
        maneuvers: Candidate maneuvers.
        objective: Objective that ranks them.
        model: Model of the pursuer.
        rules: Rules of a step.
        field: Distance from obstacles.
        table: Value table after the horizon.
    """

    maneuvers: CandidateManeuvers
    objective: ManeuverObjective
    model: PursuerModel
    rules: StepRules
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
    field, maneuvers, model = problem.field, problem.maneuvers, problem.model
    table = problem.table
    side = 0.0
    for n in range(len(turns)):
        if n >= given:
            if side == 0.0:
                dx, dy = both.px - both.ex, both.py - both.ey
                left = both.ec * dy - both.es * dx
                side = -1.0 if left > 0.0 else 1.0
            turns[n] = law_turn(both, side, maneuvers.angle, rules.share)
        half = half_turn(0.5 * turns[n])
        pace = maneuvers.still if n < spot else 1.0
        both = step_both(both, half, pace, model, rules)
        score = judge(both, score, objective, field)
        if score <= worst:
            return score, n + 1
    if table.values.shape[0] > 0:
        score = min(score, min(value_at(table, both), objective.enough))
    return score, len(turns)
