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
from ...theory.unicycle.compilation import compiled
from .candidate_maneuvers import (
    DEEPEST,
    BestManeuver,
    CandidateManeuvers,
    ManeuverObjective,
)
from .maneuver_rollout import follow, judge
from .step_motion import PlayerPair, StepRules, half_turn, step_both
from .value_lookup import ValueTable


@compiled
def descend(
    both: PlayerPair,
    start: float,
    first: int,
    made: int,
    best: float,
    maneuvers: CandidateManeuvers,
    rules: StepRules,
    aims: ManeuverObjective,
    packed: PackedObstacles,
    table: ValueTable,
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
        maneuvers: Candidate maneuvers.
        rules: Rules of a step.
        aims: Objective.
        packed: Obstacles.
        table: Value table after the horizon.
        chosen: Output: turns of the best maneuver, if better. Shape
            (horizon + spots,).
        work: Scratch array of the same shape.

    Returns:
        Best score, and total number of steps rolled out.
    """
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
        c, s, ratio = half_turn(0.5 * u)
        for n in range(pieces[level]):
            here = step_both(here, c, s, ratio, rules)
            score = judge(here, score, aims, packed)
            work[at + n] = u
            made += 1
            if score <= best + aims.gain:
                break
        if score <= best + aims.gain:
            continue
        at += pieces[level]
        if level < last:
            level += 1
            index[level], begins[level], scores[level] = 0, at, score
            for i in range(8):
                states[level, i] = here[i]
            continue
        score, more = follow(
            here,
            score,
            work[at:],
            0,
            0,
            rules,
            first + maneuvers.horizon - at,
            best + aims.gain,
            maneuvers.angle,
            rules,
            aims,
            packed,
            table,
        )
        made += more
        if score > best + aims.gain:
            best = score
            chosen[:] = work
            if best >= start:
                break
    return best, made


@compiled
def search(
    both: PlayerPair,
    plan: Any,
    planned: int,
    maneuvers: CandidateManeuvers,
    rules: StepRules,
    aims: ManeuverObjective,
    packed: PackedObstacles,
    table: ValueTable,
    chosen: Any,
    work: Any,
) -> tuple[float, int, int]:
    """Find the best maneuver; see :func:`look_ahead`.

    Args:
        both: State of both players.
        plan: Turns of the previously planned steps. Shape (n,).
        planned: Number of initial planned steps on the spot.
        maneuvers: Candidate maneuvers.
        rules: Rules of a step.
        aims: Objective.
        packed: Obstacles.
        table: Value table after the horizon.
        chosen: Output: turns of the best maneuver. Shape (horizon +
            spots,).
        work: Scratch array of the same shape.

    Returns:
        Its score, the number of steps rolled out, and the number of initial
        steps on the spot.
    """
    horizon, angle = maneuvers.horizon, maneuvers.angle
    start, spot = aims.enough, 0
    still = StepRules(
        rules.evader_stride * maneuvers.still,
        rules.evader_share,
        rules.pursuer_stride,
        rules.pursuer_share,
        rules.lead,
    )
    best, made = follow(
        both,
        start,
        chosen,
        0,
        0,
        still,
        horizon,
        -inf,
        angle,
        rules,
        aims,
        packed,
        table,
    )
    if len(plan) > 0:
        for n in range(len(plan)):
            work[n] = plan[n]
        # A tie keeps the plan.
        score, more = follow(
            both,
            start,
            work,
            len(plan),
            planned,
            still,
            horizon,
            best - aims.gain,
            angle,
            rules,
            aims,
            packed,
            table,
        )
        made += more
        if score > best - aims.gain:
            best, spot = score, planned
            chosen[:] = work
    if len(maneuvers.pieces) == 0 or best >= start:
        return best, made, spot
    found, made = descend(
        both,
        start,
        0,
        made,
        best,
        maneuvers,
        rules,
        aims,
        packed,
        table,
        chosen,
        work,
    )
    if found > best:
        best, spot = found, 0
    if best >= aims.tight:
        return best, made, spot
    most = np.abs(maneuvers.turns).max()
    for side in (-1.0, 1.0):
        here, score = both, start
        c, s, ratio = half_turn(0.5 * side * most)
        for n in range(maneuvers.spots):
            here = step_both(here, c, s, ratio, still)
            score = judge(here, score, aims, packed)
            work[n] = side * most
            made += 1
            if score <= best + aims.gain:
                break
            if n % 2 == 0:
                continue
            found, made = descend(
                here,
                score,
                n + 1,
                made,
                best,
                maneuvers,
                rules,
                aims,
                packed,
                table,
                chosen,
                work,
            )
            if found > best:
                best, spot = found, n + 1
    return best, made, spot


def look_ahead(
    both: PlayerPair,
    plan: tuple[float, ...],
    maneuvers: CandidateManeuvers,
    rules: StepRules,
    aims: ManeuverObjective,
    packed: PackedObstacles,
    table: ValueTable,
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
        rules: Rules of a step.
        aims: Objective.
        packed: Obstacles.
        table: Value table after the horizon.
        planned: Number of initial planned steps on the spot.
    """
    horizon = maneuvers.horizon
    chosen = np.zeros(horizon + maneuvers.spots)
    score, steps, spot = search(
        both,
        np.array(plan[:horizon], dtype=np.float64),
        min(planned, horizon),
        maneuvers,
        rules,
        aims,
        packed,
        table,
        chosen,
        np.zeros_like(chosen),
    )
    return BestManeuver(score, chosen[: horizon + spot], steps, spot)
