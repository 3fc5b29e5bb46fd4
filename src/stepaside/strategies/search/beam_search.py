"""Beam search over the evader's steps, against a model of the pursuer.

A beam of states is advanced step by step with every action. States that are
captured or touch an obstacle are dropped; of those that are nearly alike the
best goes on, then the others, by rank. The last that remains has survived
longest.
"""

from math import cos, inf, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from ...arena.obstacles import clearance_at
from ...core.compilation import compiled, compiled_loop, inlined
from .step_motion import (
    CLEAR,
    ENOUGH,
    Objective,
    PlayerPair,
    PursuerModel,
    judge,
    pair_in,
    pursue,
    required,
    store,
    walk_arc,
)

EVADER_CELL, PURSUER_CELL = 0.08, 0.12  # that count as alike, in [m]
HEADINGS = 16  # sectors that count as alike
BETWEEN = 0.41421356  # tangent of the angle of a sector
BESIDE = 0.2  # worth of the pursuer's bearing, in [m] per [rad]
CLEARER = 0.3  # worth of clearance, in [m] per [m]
FARTHEST = 1.5  # distance beyond which no more is gained, in [m]
GRAIN = 1e-3  # of ranks that count as equal, in [m]
BEST = FARTHEST + BESIDE * pi + CLEARER * CLEAR + 3.0 * ENOUGH  # rank, [m]
GRAINS = int(BEST / GRAIN) + 2


class BeamRules(NamedTuple):
    """Size of the search, and rank of its states."""

    width: int  # number of states that go on
    horizon: int  # number of steps
    caution: float = 0.0  # worth of the least distance [m] per [m]


class Successors(NamedTuple):
    """Successors of the states of a beam: n rows."""

    poses: Any  # positions [m], headings of the evader, score [m]. (n, 5)
    ranks: Any  # [m]
    keys: Any  # which nearly equal states have in common
    origins: Any  # numbers of the state and of the action. (n, 2)
    order: Any  # of falling ranks
    firsts: Any  # memory of the sorting


@inlined
def arc_cosine(value: float) -> float:
    """Return the angle of a cosine within 7e-5 rad.

    Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.45.
    """
    z = min(abs(value), 1.0)
    angle: float = sqrt(1.0 - z) * (
        1.5707288 + z * (-0.2121144 + z * (0.0742610 - z * 0.0187293))
    )
    return angle if value >= 0.0 else pi - angle


@inlined
def action_arcs(actions: Any, stride: float) -> Any:
    """Return way ahead and to the left [m], cosine and sine of each turn.

    The last column has the speed factor.
    """
    arcs = np.empty((len(actions), 5))
    for k in range(len(actions)):
        turn, pace = actions[k, 0], actions[k, 1]
        x, y, _, _ = walk_arc(0.0, 0.0, 1.0, 0.0, -stride * pace, turn)
        arcs[k, 0], arcs[k, 1] = x, y
        arcs[k, 2], arcs[k, 3], arcs[k, 4] = cos(turn), sin(turn), pace
    return arcs


@inlined
def cell_of(place: float, cells: float) -> int:
    """Return the cell of a coordinate [m], given the cells per meter."""
    return int(np.floor(place * cells)) + 4096


@inlined
def sector_of(c: float, s: float) -> int:
    """Return which of 16 equal sectors a unit vector lies in."""
    u, v = abs(c), abs(s)
    sector = 8 if c > 0.0 else 0
    sector += 4 if s > 0.0 else 0
    sector += 2 if v > u else 0
    return sector + (1 if min(u, v) > BETWEEN * max(u, v) else 0)


@compiled_loop
def expand_beam(
    beam: Any,
    arcs: Any,
    model: PursuerModel,
    objective: Objective,
    caution: float,
    new: Successors,
) -> int:
    """Write the successors of all states; return their number.

    States hold both players (:class:`.PlayerPair`) and the score so far; the
    pursuer is advanced by one step. The rank of a successor is its worth: far
    away, beside the pursuer, clear; with caution, never near.
    """
    made, reach = 0, objective.clearance + CLEAR
    for b in range(len(beam)):
        state = beam[b]
        both = pair_in(state)
        ex, ey, forward, leftward = both.ex, both.ey, both.ec, both.es
        px, py, ahead, left = pursue(both, model, objective.rules)
        state[4], state[5], state[6], state[7] = px, py, ahead, left
        near = clearance_at(objective.packed, ex, ey, reach)
        near -= objective.clearance
        chased = cell_of(px, 1.0 / PURSUER_CELL) * 8191
        chased = (chased + cell_of(py, 1.0 / PURSUER_CELL)) * 8191
        for k in range(len(arcs)):
            x = ex + forward * arcs[k, 0] - leftward * arcs[k, 1]
            y = ey + leftward * arcs[k, 0] + forward * arcs[k, 1]
            c = forward * arcs[k, 2] - leftward * arcs[k, 3]
            s = leftward * arcs[k, 2] + forward * arcs[k, 3]
            after = PlayerPair(x, y, c, s, px, py, ahead, left)
            least = required(near, arcs[k, 4])
            score, away, clear = judge(after, state[8], least, -inf, objective)
            if score == -inf:
                continue
            aim = arc_cosine((ahead * (x - px) + left * (y - py)) / away)
            new.poses[made, 0], new.poses[made, 1] = x, y
            new.poses[made, 2], new.poses[made, 3] = c, s
            new.poses[made, 4] = score
            new.ranks[made] = (
                min(away, FARTHEST)
                + BESIDE * aim
                + CLEARER * min(clear, CLEAR)
                + caution * score
            )
            new.origins[made, 0], new.origins[made, 1] = b, k
            key = (chased + cell_of(x, 1.0 / EVADER_CELL)) * 8191
            key = (key + cell_of(y, 1.0 / EVADER_CELL)) * HEADINGS
            new.keys[made] = key + sector_of(c, s)
            made += 1
    return made


@inlined
def sort_ranks(new: Successors, made: int) -> None:
    """Write the order of falling ranks; equal ranks keep theirs."""
    new.firsts[:] = 0
    for m in range(made):
        new.firsts[GRAINS - int(new.ranks[m] / GRAIN)] += 1
    for g in range(GRAINS):
        new.firsts[g + 1] += new.firsts[g]
    for m in range(made - 1, -1, -1):
        g = GRAINS - int(new.ranks[m] / GRAIN)
        new.firsts[g] -= 1
        new.order[new.firsts[g]] = m


@inlined
def is_new(key: int, table: Any) -> bool:
    """Note a key in a hash table; return whether it was not there."""
    last = len(table) - 1  # a power of two less one
    place = (int(key) * 2654435761 >> 7) & last
    while table[place] != 0:
        if table[place] == key:
            return False
        place = (place + 1) & last
    table[place] = key
    return True


@compiled_loop
def select_best(
    new: Successors, made: int, old: Any, beam: Any, table: Any, chosen: Any
) -> int:
    """Write the best successors, unlike ones first; return their number.

    Parent and action of each are written to ``chosen``, (width, 2). In a
    corner few states are unlike, and small differences decide.
    """
    sort_ranks(new, made)
    table[:] = 0
    count = 0
    for alike in (False, True):
        for n in range(made):
            m = new.order[n]
            if m < 0 or count == len(beam):
                continue
            if not alike and not is_new(new.keys[m], table):
                continue
            new.order[n] = -1
            parent = new.origins[m, 0]
            for i in range(4):
                beam[count, i] = new.poses[m, i]
                beam[count, 4 + i] = old[parent, 4 + i]
            beam[count, 8] = new.poses[m, 4]
            chosen[count, 0], chosen[count, 1] = parent, new.origins[m, 1]
            count += 1
    return count


@inlined
def successors(number: int) -> Successors:
    """Return memory for a number of successors."""
    return Successors(
        np.zeros((number, 5)),
        np.zeros(number),
        np.zeros(number, dtype=np.int64),
        np.zeros((number, 2), dtype=np.int32),
        np.zeros(number, dtype=np.int64),
        np.zeros(GRAINS + 1, dtype=np.int64),
    )


@compiled
def beam_search(
    both: PlayerPair,
    actions: Any,
    model: PursuerModel,
    objective: Objective,
    rules: BeamRules,
) -> Any:
    """Return the numbers of the actions of the game that survives longest.

    Positions are those in a frame whose origin is the centre of the room;
    actions are turn [rad] and speed factor, (k, 2). They are fewer than the
    horizon if no state of the beam survives.
    """
    arcs = action_arcs(actions, objective.rules.stride)
    width, horizon = rules.width, rules.horizon
    new, beams = successors(width * len(arcs)), np.zeros((2, width, 9))
    chosen = np.zeros((horizon, width, 2), dtype=np.int32)
    places = 4
    while places < 2 * width:
        places *= 2
    table = np.zeros(places, dtype=np.int64)
    store(both, beams[0, 0])
    beams[0, 0, 8] = objective.enough
    count, steps = 1, 0
    while steps < horizon:
        old, beam = beams[steps % 2], beams[(steps + 1) % 2]
        made = expand_beam(
            old[:count], arcs, model, objective, rules.caution, new
        )
        if made == 0:
            break
        count = select_best(new, made, old, beam, table, chosen[steps])
        steps += 1
    path, b = np.zeros(steps, dtype=np.int64), 0
    for n in range(steps - 1, -1, -1):
        path[n] = chosen[n, b, 1]
        b = chosen[n, b, 0]
    return path
