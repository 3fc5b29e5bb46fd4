"""Steps of both players, their score, and the fit of a pursuer, compiled.

The pursuer turns as :class:`~stepaside.strategies.Pursuit` does. Headings are
unit vectors to save trigonometric functions. The score of the evader is its
least distance to the pursuer, less penalties, and never increases along a
rollout: so that is left as soon as it is no better than the best so far.
"""

from math import acos, atan2, cos, hypot, inf, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from ...arena.obstacles import PackedObstacles, clearance_at
from ...core.compilation import compiled, inlined
from ...theory import laws
from ..knowledge import ON_THE_SPOT, Limits

inlined(laws.wrap_once)  # called by evasion_heading
inlined(laws.side_behind)  # called by update_side
evasion_heading = inlined(laws.evasion_heading)
update_side = inlined(laws.update_side)

ENOUGH = 0.8  # distance beyond which no more is gained, in [m]
CLEAR = 0.3  # clearance beyond the required that counts, in [m]
SLOW = 2.0 * ON_THE_SPOT  # speed factor of a turn on the spot, or less
ON_SPOT_SLACK = 0.004  # of clearance that turns on the spot may use, in [m]
LEAVING = 0.002  # clearance that an evader gains that leaves an obstacle, in
# [m]; an arc bulges by 0.0013
ITERATIONS = 4  # of Gauss-Newton; without noise the error is below 1e-9 m
DIFFERENCE = 1e-4  # of the headings that give the derivative, in [rad]


class PlayerPair(NamedTuple):
    """Position [m] and unit vector of the heading of evader and pursuer."""

    ex: float
    ey: float
    ec: float
    es: float
    px: float
    py: float
    pc: float
    ps: float


class PursuerModel(NamedTuple):
    """Model of a pursuer's steps, of the family of :class:`..Pursuit`."""

    gain: float = 1.0  # turn per bearing of its target, by the gait's
    pull: float = 0.0  # weight of the origin in the direction it heads for
    lead: float = 0.0  # of its target ahead of the evader, over the distance
    speed: float = 1.0  # stride over that of the evader


PAPERS = PursuerModel()


class StepRules(NamedTuple):
    """Rules of a step."""

    stride: float  # of the evader [m]
    share: float  # turn of a step per desired heading, kappa
    largest: float  # turn of a step [rad]: pi kappa


def step_rules(limits: Limits) -> StepRules:
    """Return the rules of a step of given limits."""
    return StepRules(limits.stride, limits.share, pi * limits.share)


@inlined
def pair_of(evader: Any, pursuer: Any) -> PlayerPair:
    """Return two poses (x [m], y [m], theta [rad]) with unit vectors."""
    x, y, e = evader[0], evader[1], evader[2]
    u, v, p = pursuer[0], pursuer[1], pursuer[2]
    return PlayerPair(x, y, cos(e), sin(e), u, v, cos(p), sin(p))


@inlined
def pair_in(row: Any) -> PlayerPair:
    """Return the poses in the first 8 values of a row."""
    return PlayerPair(
        row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]
    )


@inlined
def store(both: PlayerPair, row: Any) -> None:
    """Write poses to the first 8 values of a row."""
    for i in range(8):
        row[i] = both[i]


@inlined
def walk_arc(
    x: float, y: float, c: float, s: float, way: float, turn: float
) -> tuple[float, float, float, float]:
    """Return position and heading vector after an arc of a way and a turn.

    By power series, accurate to 1e-9 up to turns of 0.8 rad.
    """
    half = 0.5 * turn
    z = half * half
    ratio = 1.0 - z * (1.0 / 6.0 - z * (1.0 / 120.0 - z * (1.0 / 5040.0)))
    ratio += z * z * z * z * (1.0 / 362880.0)
    cosine = 1.0 - z * (0.5 - z * (1.0 / 24.0 - z * (1.0 / 720.0)))
    cosine += z * z * z * z * (1.0 / 40320.0)
    sine = half * ratio
    mc, ms = c * cosine - s * sine, s * cosine + c * sine
    way *= ratio
    return (
        x + way * mc,
        y + way * ms,
        mc * cosine - ms * sine,
        ms * cosine + mc * sine,
    )


@inlined
def evader_bearing(both: PlayerPair) -> float:
    """Return the bearing of the pursuer from the evader, in [rad]."""
    dx, dy = both.px - both.ex, both.py - both.ey
    return atan2(both.ec * dy - both.es * dx, both.ec * dx + both.es * dy)


@inlined
def pursuer_turn(
    both: PlayerPair, model: PursuerModel, rules: StepRules
) -> float:
    """Return the turn of the pursuer's step by a model, in [rad]."""
    dx, dy = both.ex - both.px, both.ey - both.py
    if model.lead != 0.0:
        reach = model.lead * sqrt(dx * dx + dy * dy)
        dx -= reach * both.ec  # it walks backward
        dy -= reach * both.es
    if model.pull != 0.0:
        inward = sqrt(both.px * both.px + both.py * both.py)
        if inward > 1e-6:
            weight = model.pull * sqrt(dx * dx + dy * dy) / inward
            dx -= weight * both.px
            dy -= weight * both.py
    aim = atan2(both.pc * dy - both.ps * dx, both.pc * dx + both.ps * dy)
    turn: float = rules.share * aim
    if model.gain != 1.0:
        turn *= model.gain
        turn = min(max(turn, -rules.largest), rules.largest)
    return turn


@inlined
def pursue(
    both: PlayerPair, model: PursuerModel, rules: StepRules
) -> tuple[float, float, float, float]:
    """Return the pursuer's position and heading vector after a step."""
    turn = pursuer_turn(both, model, rules)
    way = model.speed * rules.stride
    return walk_arc(both.px, both.py, both.pc, both.ps, way, turn)


@inlined
def step_both(
    both: PlayerPair,
    turn: float,
    pace: float,
    model: PursuerModel,
    rules: StepRules,
) -> PlayerPair:
    """Advance both by one step, the evader at a share of its stride."""
    way = -pace * rules.stride  # backward
    x, y, c, s = walk_arc(both.ex, both.ey, both.ec, both.es, way, turn)
    u, v, p, q = pursue(both, model, rules)
    return PlayerPair(x, y, c, s, u, v, p, q)


class Objective(NamedTuple):
    """Score of a step; -inf once the game is lost."""

    rules: StepRules
    packed: PackedObstacles
    clearance: float  # that the own centre requires [m]
    enough: float = ENOUGH  # distance beyond which no more is gained [m]
    capture: float = 0.0  # distance at which the game is lost [m]
    # of missing clearance, in [m] per [m]; infinite: the game is lost
    penalty: float = inf
    # cost of a bearing beyond sight, in [m] per [rad], and cosine of sight
    blindness: float = 0.0
    sight: float = -1.0


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
    known: float,
    objective: Objective,
) -> tuple[float, float, float]:
    """Return the score after one more step, the distance and the clearance.

    The clearance, in [m], is that beyond the required: it must be ``least``,
    is at least ``known``, and counts up to 0.3 m.
    """
    dx, dy = both.px - both.ex, both.py - both.ey
    away, clear = sqrt(dx * dx + dy * dy), known
    if away <= objective.capture:
        return -inf, away, clear
    reward = min(away, objective.enough)
    score = min(score, reward)
    if known < least:
        reach = objective.clearance + CLEAR
        clear = clearance_at(objective.packed, both.ex, both.ey, reach)
        clear -= objective.clearance
    if both.ec * dx + both.es * dy < objective.sight * away:
        unseen = abs(evader_bearing(both)) - acos(objective.sight)
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
    rules, side, least, clear = objective.rules, 0, 0.0, -inf
    if objective.penalty == inf:
        clear = clearance_at(
            objective.packed, both.ex, both.ey, objective.clearance
        )
        clear -= objective.clearance
    for n in range(len(moves)):
        if n >= given:
            psi = evader_bearing(both)
            side = update_side(side, psi, pi)
            moves[n, 0] = rules.share * evasion_heading(psi, side, 0.5 * pi)
            moves[n, 1] = 1.0
        if objective.penalty == inf:
            least = required(clear, moves[n, 1])
        after = step_both(both, moves[n, 0], moves[n, 1], model, rules)
        known = clear - rules.stride
        later, _, clear = judge(after, score, least, known, objective)
        if later <= worst:
            return both, score, n
        both, score = after, later
    return both, score, len(moves)


@inlined
def follow_model(
    path: Any, heading: float, model: PursuerModel, rules: StepRules, off: Any
) -> tuple[float, float, float]:
    """Walk along a path as a model turns; return the pose at its end.

    The distances from the path, less their mean, are written to ``off``.
    """
    x = y = mean_x = mean_y = 0.0
    for k in range(len(path)):
        off[k, 0], off[k, 1] = path[k, 3] - x, path[k, 4] - y
        mean_x += off[k, 0] / len(path)
        mean_y += off[k, 1] / len(path)
        if k + 1 < len(path):
            both = pair_of(path[k], (path[k, 3], path[k, 4], heading))
            dx, dy, steps = path[k + 1, 3:] - path[k, 3:]
            turn = steps * pursuer_turn(both, model, rules)
            way = hypot(dx, dy)
            x += way * cos(heading + 0.5 * turn)
            y += way * sin(heading + 0.5 * turn)
            heading += turn
    for k in range(len(path)):
        off[k, 0] -= mean_x
        off[k, 1] -= mean_y
    return x + mean_x, y + mean_y, heading


@compiled
def fit_heading(
    path: Any, model: PursuerModel, rules: StepRules
) -> tuple[tuple[float, float, float], float]:
    """Fit initial heading and position of a model to a path.

    The turn of each step follows from the model, its length from the path:
    poses of the evader, positions of the pursuer [m] and times [steps], in a
    frame whose origin is the centre of the room, (n, 6) with n > 1. Returns
    the pose of the pursuer at the end, and the mean squared distance from the
    path, in [m^2].
    """
    n = len(path)
    off, other = np.empty((n, 2)), np.empty((n, 2))
    begin = atan2(path[1, 4] - path[0, 4], path[1, 3] - path[0, 3])
    end = follow_model(path, begin, model, rules, off)
    for _ in range(ITERATIONS):
        follow_model(path, begin + DIFFERENCE, model, rules, other)
        slope = square = 0.0
        for k in range(n):
            for i in range(2):
                change = (other[k, i] - off[k, i]) / DIFFERENCE
                slope += change * off[k, i]
                square += change * change
        if square > 0.0:
            begin -= min(max(slope / square, -0.5), 0.5)
        end = follow_model(path, begin, model, rules, off)
    return end, float((off * off).sum()) / n
