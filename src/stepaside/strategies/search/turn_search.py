"""Looking ahead: sequences of turns, tried against a model of the pursuer.

A maneuver is a sequence of pieces with a constant turn each, and after them
the law of Sec. II-B until the horizon. Its score is the least distance to
the pursuer on the way, at most what is enough, less a penalty for coming
too near to what stands on the floor and for losing sight of the pursuer.
A score only falls along a maneuver: so the search goes down the tree of
pieces, and leaves a branch as soon as it is no better than the best so far.
Where no sequence is good, it also tries to turn on the spot first.
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
    """Go down the tree of pieces.

    Args:
        both: Where both are at its root.
        start: Score there.
        first: Steps before the root, whose turns stand in ``work``.
        made: Steps that were rolled out before.
        best: Best score so far.
        maneuvers: Which are tried.
        rules: Of a step.
        aims: What is good.
        packed: What stands there.
        table: What comes after the horizon.
        chosen: Where the turns are written of one that is better. Shape
            (horizon + spots,).
        work: Memory of the same shape.

    Returns:
        Best score now, and the steps that were rolled out by now.
    """
    pieces, turns = maneuvers.pieces, maneuvers.turns
    last, level = len(pieces) - 1, 0
    index = np.zeros(DEEPEST, dtype=np.int64)
    begins = np.zeros(DEEPEST, dtype=np.int64)
    scores = np.zeros(DEEPEST)
    places = np.zeros((DEEPEST, 8))
    scores[0], begins[0] = start, first
    for i in range(8):
        places[0, i] = both[i]
    while level >= 0 and made < maneuvers.most:
        if index[level] == len(turns):
            level -= 1
            continue
        u = turns[index[level]]
        index[level] += 1
        p = places[level]
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
                places[level, i] = here[i]
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
        both: Where both are.
        plan: Turns of the steps that were planned before. Shape (n,).
        planned: How many of them were to be made on the spot.
        maneuvers: Which are tried.
        rules: Of a step.
        aims: What is good.
        packed: What stands there.
        table: What comes after the horizon.
        chosen: Where the best one's turns are written. Shape (horizon +
            spots,).
        work: Memory of the same shape.

    Returns:
        Its score, the steps that were rolled out, and how many of the first
        are made on the spot.
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
        # On equal terms the plan is kept.
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
    sequence of pieces; one that is no better than those before it is not
    taken. Where the best is worse than tight, sequences that begin with a
    turn on the spot are tried, too. Without pieces it is the law.

    Args:
        both: Where both are.
        plan: Turns of the steps that were planned before and not made, [rad].
        maneuvers: Which are tried.
        rules: Of a step.
        aims: What is good.
        packed: What stands there.
        table: What comes after the horizon.
        planned: How many of the planned steps were to be made on the spot.
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
