"""Branch-and-bound search over turning sequences, with a pursuer model.

A maneuver is a sequence of pieces with a constant turn each, followed by
the law of Sec. II-B until the horizon. Its score is the least distance to
the pursuer, limited to ``enough``, less penalties for missing clearance and
for losing sight of the pursuer. The score never increases along a maneuver:
so the search descends the tree of pieces and prunes a branch as soon as it
is no better than the best maneuver so far. If no sequence is good, it also
tries sequences that begin with a turn on the spot.
"""

from math import atan2, hypot, inf, pi
from typing import Any, NamedTuple

import numpy as np

from ...arena.obstacles import PackedObstacles
from ...core.compilation import compiled, copy_values, inlined
from ...theory.value.outcomes import OutcomeRules, look_up
from ..knowledge import ON_THE_SPOT
from .distance_field import DistanceField, distance_field, field_clearance
from .step_motion import (
    PlayerPair,
    PursuerModel,
    StepRules,
    pair_in,
    step_both,
    store,
)

DEEPEST = 8  # most pieces of a maneuver, plus one
MOST = 40_000  # rolled-out steps after which no further maneuver is begun
BLINDNESS = 0.1  # cost of a bearing beyond sight, in [m] per [rad]
NO_STEPS: Any = np.int64(0)
"""Zero steps; a literal zero would compile a version of its own."""


class PursuitValues(NamedTuple):
    """Optimal closest approach on an open floor, by relative pose.

    Attributes:
        values: Values of the left half of a grid, in length units; empty for
            no table. Shape (x, y, heading).
        left: x of its first node, in length units.
        spacing: Spacing of its positions, in length units.
        unit: Length unit, in [m].
    """

    values: Any
    left: float
    spacing: float
    unit: float


NO_VALUE = PursuitValues(np.zeros((0, 0, 0), dtype=np.float32), 0.0, 1.0, 1.0)
"""No value table after the horizon."""


class TurnSearch(NamedTuple):
    """Maneuvers that the search tries, and the objective that ranks them.

    Attributes:
        pieces: Number of steps of each piece, in order. Shape (n,).
        turns: Turns per step that are tried in each piece, in [rad], the
            preferred ones first. Shape (m,).
        horizon: Number of steps of a maneuver, law included, without those
            on the spot.
        angle: Strategy alpha of the law, in [rad].
        spots: Largest number of steps that turn on the spot, by the largest
            turn, before the first piece; every second number is tried.
        enough: Distance to the pursuer beyond which no more is gained, [m].
        clearance: Required clearance of the own centre, in [m].
        penalty: Cost of missing clearance, in [m] per [m].
        sight: Largest bearing at which the pursuer is visible, in [rad].
        gain: Improvement over the present maneuver that replaces it, in [m].
        tight: Score below which turns on the spot are tried as well, [m].
    """

    pieces: Any
    turns: Any
    horizon: int
    angle: float = pi / 2
    spots: int = 0
    enough: float = inf
    clearance: float = 0.2
    penalty: float = 5.0
    sight: float = inf
    gain: float = 1e-6
    tight: float = -inf


class SearchProblem(NamedTuple):
    """All that a rollout needs: search, models, obstacles and value table."""

    search: TurnSearch
    model: PursuerModel
    rules: StepRules
    field: DistanceField
    table: PursuitValues


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
    spot: int


@inlined
def judge(
    both: PlayerPair, score: float, search: TurnSearch, field: DistanceField
) -> float:
    """Return the score after one more step, given the score before it."""
    dx, dy = both.px - both.ex, both.py - both.ey
    reward = min((dx * dx + dy * dy) ** 0.5, search.enough)
    if reward < score:
        score = reward
    missing = search.clearance - field_clearance(field, both.ex, both.ey)
    if search.sight < pi:
        psi = abs(
            atan2(both.ec * dy - both.es * dx, both.ec * dx + both.es * dy)
        )
        if psi > search.sight:
            score = min(score, reward - BLINDNESS * (psi - search.sight))
    if missing > 0.0:
        score = min(score, reward - search.penalty * missing)
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


@inlined
def value_at(table: PursuitValues, both: PlayerPair) -> float:
    """Return the optimal closest approach from a state, in [m]."""
    columns, rows, headings = table.values.shape
    rules = OutcomeRules(
        table.left, 0.0, table.spacing, columns, rows, headings, inf,
        0.0, False, 1, 0.0, 0.0, 0.0,
    )  # fmt: skip
    dx, dy = both.ex - both.px, both.ey - both.py
    x = (both.pc * dx + both.ps * dy) / table.unit
    y = (both.pc * dy - both.ps * dx) / table.unit
    # The evader walks backwards: it moves against its heading.
    theta = atan2(
        both.ec * both.ps - both.es * both.pc,
        -both.ec * both.pc - both.es * both.ps,
    )
    found = look_up(table.values, x, y, theta, rules)
    value: float = min(hypot(dx, dy), found * table.unit)
    return value


@compiled
def roll_out(
    both: PlayerPair,
    score: float,
    turns: Any,
    given: int,
    spot: int,
    worst: float,
    problem: SearchProblem,
) -> tuple[PlayerPair, float, int]:
    """Roll out given turns, then the law; return state, score and steps.

    The turns of the law are filled in. The first steps may turn on the spot;
    at a score that is no better than the worst the rollout ends.
    """
    search, rules = problem.search, problem.rules
    field, model = problem.field, problem.model
    side = 0.0
    for n in range(len(turns)):
        if n >= given:
            if side == 0.0:
                dx, dy = both.px - both.ex, both.py - both.ey
                left = both.ec * dy - both.es * dx
                side = -1.0 if left > 0.0 else 1.0
            turns[n] = law_turn(both, side, search.angle, rules.share)
        pace = ON_THE_SPOT if n < spot else 1.0
        both = step_both(both, turns[n], pace, model, rules)
        score = judge(both, score, search, field)
        if score <= worst:
            return both, score, n + 1
    return both, score, len(turns)


@compiled
def final_score(
    both: PlayerPair, score: float, worst: float, problem: SearchProblem
) -> float:
    """Return the score with the value at the horizon, if it matters."""
    table = problem.table
    if score > worst and table.values.shape[0] > 0:
        value = value_at(table, both)
        score = min(score, min(value, problem.search.enough))
    return score


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
    """Descend the tree of pieces; return best score and steps rolled out.

    The root has a state, a score, and a number of steps before it, whose turns
    are in the scratch array; turns that are better than the best are written
    to ``chosen``. Both have shape (horizon + spots,).
    """
    search = problem.search
    pieces, turns = search.pieces, search.turns
    last, level = len(pieces) - 1, 0
    index = np.zeros(DEEPEST, dtype=np.int64)
    begins = np.zeros(DEEPEST, dtype=np.int64)
    scores = np.zeros(DEEPEST)
    states = np.zeros((DEEPEST, 8))
    scores[0], begins[0] = start, first
    store(both, states[0])
    while level >= 0 and made < MOST:
        if index[level] == len(turns):
            level -= 1
            continue
        at, worst = begins[level], best + search.gain
        piece = work[at : at + pieces[level]]
        for n in range(len(piece)):
            piece[n] = turns[index[level]]
        index[level] += 1
        here, score, more = roll_out(
            pair_in(states[level]),
            scores[level],
            piece,
            len(piece),
            0,
            worst,
            problem,
        )
        made += more
        if score <= worst:
            continue
        at += len(piece)
        if level < last:
            level += 1
            index[level], begins[level], scores[level] = 0, at, score
            store(here, states[level])
            continue
        rest = work[at : first + search.horizon]
        here, score, more = roll_out(here, score, rest, 0, 0, worst, problem)
        score = final_score(here, score, worst, problem)
        made += more
        if score > worst:
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

    Returns best score, steps rolled out, and steps on the spot of the best.
    """
    search = problem.search
    most = 0.0
    for u in search.turns:
        most = max(most, abs(u))
    for side in (-1.0, 1.0):
        here, score = both, search.enough
        for n in range(search.spots):
            work[n] = side * most
            worst, turn = best + search.gain, work[n : n + 1]
            here, score, more = roll_out(
                here, score, turn, 1, 1, worst, problem
            )
            made += more
            if score <= worst:
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
def look_ahead(
    both: PlayerPair,
    plan: Any,
    planned: int,
    search: TurnSearch,
    model: PursuerModel,
    rules: StepRules,
    packed: PackedObstacles,
    table: PursuitValues,
) -> BestManeuver:
    """Find the best maneuver.

    The law alone is tried first, then the rest of the plan, and then every
    sequence of pieces; a maneuver is chosen only if it improves on those
    before it. If the best score is below ``tight``, sequences that begin
    with a turn on the spot are tried, too. Without pieces it is the law.

    Args:
        both: State of both players.
        plan: Turns of the previously planned steps to come, in [rad].
        planned: Number of initial planned steps on the spot.
        search: Maneuvers, and the objective that ranks them.
        model: Model of the pursuer.
        rules: Rules of a step.
        packed: Obstacles.
        table: Value table after the horizon.
    """
    horizon = search.horizon
    chosen = np.zeros(horizon + search.spots)
    work = np.zeros(len(chosen))
    reach = len(chosen) * rules.stride
    field = distance_field(packed, search.clearance, both.ex, both.ey, reach)
    problem = SearchProblem(search, model, rules, field, table)
    start, spot = search.enough, 0
    here, best, made = roll_out(
        both, start, chosen[:horizon], 0, 0, -inf, problem
    )
    best = final_score(here, best, -inf, problem)
    given = min(len(plan), horizon)
    if given > 0:
        copy_values(plan[:given], work)
        planned = min(planned, horizon)
        worst = best - search.gain  # a tie keeps the plan
        here, score, more = roll_out(
            both, start, work[:horizon], given, planned, worst, problem
        )
        score = final_score(here, score, worst, problem)
        made += more
        if score > worst:
            best, spot = score, planned
            copy_values(work, chosen)
    if len(search.pieces) > 0 and best < start:
        found, made = descend(
            both, start, NO_STEPS, made, best, problem, chosen, work
        )
        if found > best:
            best, spot = found, 0
        if best < search.tight:
            best, made, spot = search_on_spot(
                both, best, made, spot, problem, chosen, work
            )
    return BestManeuver(best, chosen[: horizon + spot], made, spot)
