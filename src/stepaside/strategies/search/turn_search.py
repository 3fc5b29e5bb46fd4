"""Branch-and-bound search over turning sequences, with a pursuer model.

A maneuver is a sequence of pieces with a constant turn each, followed by
the law of Sec. II-B until the horizon. Its score is the least distance to
the pursuer, limited to ``enough``, less penalties for missing clearance and
for losing sight of the pursuer. The score never increases along a maneuver:
so the search descends the tree of pieces and prunes a branch as soon as it
is no better than the best maneuver so far. If no sequence is good, it also
tries sequences that begin with a turn on the spot.
"""

from math import inf
from typing import Any

import numpy as np

from ...arena.obstacles import PackedObstacles
from ...core.compilation import compiled, copy_values
from .distance_field import distance_field
from .maneuvers import (
    DEEPEST,
    BestManeuver,
    CandidateManeuvers,
    ManeuverObjective,
    SearchProblem,
    follow,
    judge,
)
from .step_motion import (
    PlayerPair,
    PursuerModel,
    StepRules,
    half_turn,
    step_both,
)
from .value_lookup import PursuitValues

NO_STEPS: Any = np.int64(0)
"""Zero steps; a literal zero would compile a version of its own."""


@compiled
def descend(
    both: PlayerPair,
    start: float,
    first: int,
    made: int,
    best: float,
    problem: SearchProblem,
    chosen: Any,
    work: Any,
) -> tuple[float, int]:
    """Descend the tree of pieces.

    Args:
        both: State of both players at the root.
        start: Score at the root.
        first: Number of steps before the root; their turns are in ``work``.
        made: Number of steps rolled out before.
        best: Best score so far.
        problem: Maneuvers, objective and rules.
        chosen: Output: turns of the best maneuver, if better. Shape
            (horizon + spots,).
        work: Scratch array of the same shape.

    Returns:
        Best score, and total number of steps rolled out.
    """
    maneuvers, objective = problem.maneuvers, problem.objective
    rules, field, model = problem.rules, problem.field, problem.model
    pieces, turns = maneuvers.pieces, maneuvers.turns
    last, level = len(pieces) - 1, 0
    index = np.zeros(DEEPEST, dtype=np.int64)
    begins = np.zeros(DEEPEST, dtype=np.int64)
    scores = np.zeros(DEEPEST)
    states = np.zeros((DEEPEST, 8))
    scores[0], begins[0] = start, first
    for i in range(8):
        states[0, i] = both[i]
    while level >= 0 and made < maneuvers.most:
        if index[level] == len(turns):
            level -= 1
            continue
        u = turns[index[level]]
        index[level] += 1
        p = states[level]
        here = PlayerPair(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7])
        score, at = scores[level], begins[level]
        half = half_turn(0.5 * u)
        for n in range(pieces[level]):
            here = step_both(here, half, 1.0, model, rules)
            score = judge(here, score, objective, field)
            work[at + n] = u
            made += 1
            if score <= best + objective.gain:
                break
        if score <= best + objective.gain:
            continue
        at += pieces[level]
        if level < last:
            level += 1
            index[level], begins[level], scores[level] = 0, at, score
            for i in range(8):
                states[level, i] = here[i]
            continue
        rest = work[at : first + maneuvers.horizon]
        score, more = follow(
            here, score, rest, 0, 0, best + objective.gain, problem
        )
        made += more
        if score > best + objective.gain:
            best = score
            copy_values(work, chosen)
            if best >= start:
                break
    return best, made


@compiled
def search_on_spot(
    both: PlayerPair,
    best: float,
    made: int,
    spot: int,
    problem: SearchProblem,
    chosen: Any,
    work: Any,
) -> tuple[float, int, int]:
    """Try sequences behind turns on the spot, by the sharpest turn.

    Args:
        both: State of both players.
        best: Best score so far.
        made: Number of steps rolled out before.
        spot: Number of initial steps on the spot of the best maneuver.
        problem: Maneuvers, objective and rules.
        chosen: Turns of the best maneuver; replaced by better ones.
        work: Scratch array of the same shape.

    Returns:
        Best score, number of steps rolled out, and number of initial steps
        on the spot.
    """
    maneuvers, objective = problem.maneuvers, problem.objective
    most = 0.0
    for u in maneuvers.turns:
        most = max(most, abs(u))
    for side in (-1.0, 1.0):
        here, score = both, objective.enough
        half = half_turn(0.5 * side * most)
        for n in range(maneuvers.spots):
            here = step_both(
                here, half, maneuvers.still, problem.model, problem.rules
            )
            score = judge(here, score, objective, problem.field)
            work[n] = side * most
            made += 1
            if score <= best + objective.gain:
                break
            if n % 2 == 0:
                continue
            found, made = descend(
                here, score, n + 1, made, best, problem, chosen, work
            )
            if found > best:
                best, spot = found, n + 1
    return best, made, spot


@compiled
def search(
    both: PlayerPair,
    plan: Any,
    planned: int,
    maneuvers: CandidateManeuvers,
    model: PursuerModel,
    rules: StepRules,
    objective: ManeuverObjective,
    packed: PackedObstacles,
    table: PursuitValues,
) -> tuple[float, int, int, Any]:
    """Find the best maneuver; see :func:`look_ahead`.

    Returns:
        Its score, the number of steps rolled out, the number of initial
        steps on the spot, and the turn of each step.
    """
    horizon = maneuvers.horizon
    chosen = np.zeros(horizon + maneuvers.spots)
    work = np.zeros(len(chosen))
    reach = len(chosen) * rules.stride
    field = distance_field(
        packed, objective.clearance, both.ex, both.ey, reach
    )
    problem = SearchProblem(maneuvers, objective, model, rules, field, table)
    start, spot = objective.enough, 0
    rest = chosen[:horizon]
    best, made = follow(both, start, rest, 0, 0, -inf, problem)
    if len(plan) > 0:
        copy_values(plan, work)
        # A tie keeps the plan.
        worst = best - objective.gain
        score, more = follow(
            both, start, work[:horizon], len(plan), planned, worst, problem
        )
        made += more
        if score > worst:
            best, spot = score, planned
            copy_values(work, chosen)
    if len(maneuvers.pieces) > 0 and best < start:
        found, made = descend(
            both, start, NO_STEPS, made, best, problem, chosen, work
        )
        if found > best:
            best, spot = found, 0
        if best < objective.tight:
            best, made, spot = search_on_spot(
                both, best, made, spot, problem, chosen, work
            )
    return best, made, spot, chosen


def look_ahead(
    both: PlayerPair,
    plan: tuple[float, ...],
    maneuvers: CandidateManeuvers,
    model: PursuerModel,
    rules: StepRules,
    objective: ManeuverObjective,
    packed: PackedObstacles,
    table: PursuitValues,
    *,
    planned: int = 0,
) -> BestManeuver:
    """Find the best maneuver.

    The law alone is tried first, then the rest of the plan, and then every
    sequence of pieces; a maneuver is chosen only if it improves on those
    before it. If the best score is below ``tight``, sequences that begin
    with a turn on the spot are tried, too. Without pieces it is the law.

    Args:
        both: State of both players.
        plan: Turns of the previously planned steps to come, in [rad].
        maneuvers: Candidate maneuvers.
        model: Model of the pursuer.
        rules: Rules of a step.
        objective: Objective that ranks the maneuvers.
        packed: Obstacles.
        table: Value table after the horizon.
        planned: Number of initial planned steps on the spot.
    """
    horizon = maneuvers.horizon
    score, steps, spot, turns = search(
        both,
        np.array(plan[:horizon], dtype=np.float64),
        min(planned, horizon),
        maneuvers,
        model,
        rules,
        objective,
        packed,
        table,
    )
    return BestManeuver(score, turns[: horizon + spot], steps, spot)
