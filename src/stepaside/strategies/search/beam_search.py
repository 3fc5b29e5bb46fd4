"""Beam search over the evader's steps, against a model of the pursuer.

A beam of states is advanced step by step: each with every action, the
pursuer by its model. States that are captured or touch an obstacle are
dropped; of those that are nearly alike one is kept; and the best by
:func:`rank` go on. So the last state that remains has survived longest.
"""

from math import atan2, cos, pi, sin, sqrt, tau
from typing import Any

import numpy as np

from ...arena.obstacles import PackedObstacles
from ...core.compilation import compiled, inlined
from .distance_field import DistanceField, distance_field, field_clearance
from .pursuer_model import BeamRules, PursuerModel, model_turn

PLACES = 1 << 14  # of the table of states that are alike
EVADER_CELL, PURSUER_CELL = 0.08, 0.12  # that count as alike, in [m]
HEADINGS = 16  # sectors that count as alike
BESIDE = 0.2  # worth of the pursuer's bearing, in [m] per [rad]
CLEAR = 0.3  # worth of clearance, in [m] per [m], and the most that counts
SLOW = 0.1  # speed factor of a turn on the spot, or less
ON_SPOT_SLACK = 0.004  # of clearance that turns on the spot may use, in [m]
FARTHEST = 1.5  # distance beyond which no more is gained, in [m]


@inlined
def arc_end(
    pose: tuple[float, float, float], way: float, turn: float
) -> tuple[float, float, float]:
    """Return the pose after an arc of a length [m] and a turn [rad]."""
    half = 0.5 * turn
    z = half * half
    chord = way * (1.0 - z / 6.0 * (1.0 - z / 20.0))
    x, y, theta = pose
    return (
        x + chord * cos(theta + half),
        y + chord * sin(theta + half),
        theta + turn,
    )


@inlined
def rank(
    evader: tuple[float, float, float],
    pursuer: tuple[float, float, float],
    clear: float,
) -> float:
    """Return the worth of a state: far away, beside the pursuer, clear."""
    dx, dy = evader[0] - pursuer[0], evader[1] - pursuer[1]
    away = sqrt(dx * dx + dy * dy)
    aim = (atan2(dy, dx) - pursuer[2] + pi) % tau - pi
    found: float = (
        min(away, FARTHEST) + BESIDE * abs(aim) + CLEAR * min(clear, CLEAR)
    )
    return found


@inlined
def state_key(
    evader: tuple[float, float, float], pursuer: tuple[float, float, float]
) -> int:
    """Return a number that states have in common that are nearly alike."""
    key = 1
    for place, cell in (
        (evader[0], EVADER_CELL),
        (evader[1], EVADER_CELL),
        (pursuer[0], PURSUER_CELL),
        (pursuer[1], PURSUER_CELL),
    ):
        key = key * 8191 + int(np.floor(place / cell)) + 4096
    return key * HEADINGS + int((evader[2] % tau) / tau * HEADINGS)


@inlined
def expand(
    state: Any,
    actions: Any,
    model: PursuerModel,
    field: DistanceField,
    rules: BeamRules,
    new: Any,
    keys: Any,
    made: int,
) -> int:
    """Add the successors of a state to ``new``; return their number.

    Args:
        state: Poses of evader and pursuer, and the rank. Shape (7,).
        actions: Turn [rad] and speed factor of each action. Shape (k, 2).
        model: Model of the pursuer.
        field: Distance from obstacles.
        rules: Rules of the steps.
        new: Output: states and the action of each. Shape (n, 8).
        keys: Output: keys of the states. Shape (n,).
        made: Number of states in ``new`` before.
    """
    evader = (state[0], state[1], state[2])
    pursuer = (state[3], state[4], state[5])
    turn = model_turn(evader, pursuer, model, rules)
    chase = arc_end(pursuer, model.speed * rules.stride, turn)
    for k in range(len(actions)):
        way = -rules.stride * actions[k, 1]
        after = arc_end(evader, way, actions[k, 0])
        dx, dy = after[0] - chase[0], after[1] - chase[1]
        if dx * dx + dy * dy <= rules.capture * rules.capture:
            continue
        clear = field_clearance(field, after[0], after[1]) - rules.clearance
        if clear < (0.0 if actions[k, 1] > SLOW else -ON_SPOT_SLACK):
            continue
        for i in range(3):
            new[made, i], new[made, 3 + i] = after[i], chase[i]
        new[made, 6] = rank(after, chase, clear)
        new[made, 7] = k
        keys[made] = state_key(after, chase)
        made += 1
    return made


@inlined
def is_new(key: int, table: Any) -> bool:
    """Note a key in a hash table; return whether it was not there."""
    place = (key * 2654435761 >> 7) & (PLACES - 1)
    while table[place] != 0:
        if table[place] == key:
            return False
        place = (place + 1) & (PLACES - 1)
    table[place] = key
    return True


@compiled
def beam_search(
    start: Any,
    actions: Any,
    model: PursuerModel,
    packed: PackedObstacles,
    rules: BeamRules,
) -> Any:
    """Return the actions of the game that survives longest.

    Args:
        start: Poses (x [m], y [m], theta [rad]) of evader and pursuer in a
            frame whose origin is the centre of the room. Shape (6,).
        actions: Turn [rad] and speed factor of each action. Shape (k, 2).
        model: Model of the pursuer.
        packed: Obstacles.
        rules: Rules of the steps, and size of the search.

    Returns:
        Number of the action of each step; fewer than the horizon if no
        state of the beam survives it. Shape (n,).
    """
    kinds, width, horizon = len(actions), rules.width, rules.horizon
    reach = horizon * rules.stride + 0.2
    field = distance_field(
        packed, rules.clearance + CLEAR, start[0], start[1], reach
    )
    beam, new = np.zeros((width, 7)), np.zeros((width * kinds, 8))
    parents = np.zeros((horizon, width), dtype=np.int64)
    taken = np.zeros((horizon, width), dtype=np.int64)
    keys = np.zeros(width * kinds, dtype=np.int64)
    origin = np.zeros(width * kinds, dtype=np.int64)
    table = np.zeros(PLACES, dtype=np.int64)
    beam[0, :6] = start
    count, steps = 1, 0
    while steps < horizon:
        made = 0
        for b in range(count):
            more = expand(
                beam[b], actions, model, field, rules, new, keys, made
            )
            origin[made:more] = b
            made = more
        if made == 0:
            break
        table[:] = 0
        count = 0
        for m in np.argsort(-new[:made, 6]):
            if not is_new(keys[m], table):
                continue
            beam[count] = new[m, :7]
            parents[steps, count] = origin[m]
            taken[steps, count] = int(new[m, 7])
            count += 1
            if count == width:
                break
        steps += 1
    path, b = np.zeros(steps, dtype=np.int64), 0
    for n in range(steps - 1, -1, -1):
        path[n] = taken[n, b]
        b = parents[n, b]
    return path


@compiled
def survived_steps(
    start: Any,
    moves: Any,
    model: PursuerModel,
    packed: PackedObstacles,
    rules: BeamRules,
) -> tuple[int, float]:
    """Return the steps that given moves survive, and the rank at their end.

    Args:
        start: As in :func:`beam_search`.
        moves: Turn [rad] and speed factor of each step. Shape (n, 2).
        model: Model of the pursuer.
        packed: Obstacles.
        rules: Rules of the steps.
    """
    reach = len(moves) * rules.stride + 0.2
    field = distance_field(
        packed, rules.clearance + CLEAR, start[0], start[1], reach
    )
    state, new = np.zeros(7), np.zeros((1, 8))
    keys = np.zeros(1, dtype=np.int64)
    state[:6] = start
    for n in range(len(moves)):
        move = moves[n : n + 1]
        if not expand(state, move, model, field, rules, new, keys, 0):
            return n, state[6]
        state[:] = new[0, :7]
    return len(moves), state[6]
