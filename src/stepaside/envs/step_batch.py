"""Many games of :class:`~stepaside.strategies.StepGame` in compiled loops.

A player follows the paper's law, stands, or is given its intents from
outside, as in learning.
"""

from math import atan2, inf, pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arena.obstacles import PackedObstacles, hull_clearance
from ..core.compilation import compiled, copy_values, inlined
from ..core.poses import Array
from ..strategies.learned.observation_terms import (
    CLEAREST,
    FARTHEST,
    FASTEST,
    FULL_STATE_TERMS,
    SENSED_TERMS,
    ring_points,
)
from ..strategies.search.step_motion import walk_arc
from ..theory import laws

inlined(laws.wrap_once)  # called by evasion_heading
inlined(laws.side_behind)  # called by update_side
evasion_heading = inlined(laws.evasion_heading)
update_side = inlined(laws.update_side)
is_evading = inlined(laws.is_evading)

RUNNING, CAPTURED, TOUCHED = 0, 1, 2
"""Outcome codes of a game."""
STANDS, PURSUES, EVADES = 0, 1, 2
"""Codes of the laws that a player may follow."""
TERM_CODES = {
    name: code for code, name in enumerate((*SENSED_TERMS, *FULL_STATE_TERMS))
}
"""Terms that :func:`observe_games` computes."""
RING = ring_points()


class BatchState(NamedTuple):
    """State of n games; the arrays are changed in place.

    Attributes:
        poses: x, y [m], cosine and sine of the heading of pursuer and
            evader. Shape (n, 2, 4).
        sights: The last lines of sight, in a ring by decision whose length
            is a power of two: components of the unit vector from pursuer to
            evader, and the distance [m]. Shape (n, history, 3).
        decisions: Decisions so far. Shape (n,).
        sides: Side of an evader that follows the law; 0 while it does not
            evade. Shape (n, 2).
        walking: Whether the last intent of each player was to walk. Shape
            (n, 2).
        closest: Closest approach so far; 0 after contact with an obstacle,
            in [m]. Shape (n,).
        rooms: Index of the room of each game. Shape (n,).
    """

    poses: Array
    sights: Array
    decisions: NDArray[np.int64]
    sides: NDArray[np.int64]
    walking: NDArray[np.bool_]
    closest: Array
    rooms: NDArray[np.int64]


class BatchRules(NamedTuple):
    """Rules of a step game, as numbers.

    Attributes:
        stride: Path length between two decisions, in [m].
        share: Turn of a step per desired heading, kappa.
        turn: Largest turn of a step, in [rad].
        parts: Decisions per step.
        period: Time between two decisions, in [s].
        speed: Speed of the template, in [m/s].
        gain: Steering gain, in [1/s].
        capture: Capture distance, in [m].
        body_radius: Clearance below which the evader touches, in [m].
        limit: Decisions until a game ends.
        lag: Decisions over which rates are differences.
        least_lag: Least number of decisions over which they are known.
    """

    stride: float
    share: float
    turn: float
    parts: float
    period: float
    speed: float
    gain: float
    capture: float
    body_radius: float
    limit: int
    lag: int
    least_lag: int


class BatchLaw(NamedTuple):
    """Law of a player, as numbers.

    Attributes:
        code: :data:`STANDS`, :data:`PURSUES` or :data:`EVADES`.
        saturated: Whether it turns by (6) instead of (8).
        ratio: Gain of a pursuer over that of its gait.
        angle: Evasion angle, in [rad].
        safety_radius: Distance at which evasion begins, in [m].
        release: Distance at which it ends, in [m].
        hysteresis: Angle past which the side changes, in [rad].
    """

    code: int = STANDS
    saturated: bool = False
    ratio: float = 1.0
    angle: float = 0.0
    safety_radius: float = inf
    release: float = inf
    hysteresis: float = 0.0


class RoomBatch(NamedTuple):
    """Obstacles of many rooms.

    Attributes:
        packed: Obstacles of all rooms.
        firsts: Index of the first obstacle of each room, and the number of
            obstacles. Shape (rooms + 1,).
    """

    packed: PackedObstacles
    firsts: NDArray[np.int64]


@inlined
def room_clearance(
    rooms: RoomBatch, room: int, x: float, y: float, enough: float
) -> float:
    """Return the clearance of a point in one of the rooms, in [m]."""
    nearest = enough
    for k in range(rooms.firsts[room], rooms.firsts[room + 1]):
        nearest = hull_clearance(rooms.packed, k, x, y, nearest)
    return nearest


@inlined
def record_sight(state: BatchState, i: int) -> float:
    """Store the line of sight of a game, and return the distance in [m]."""
    pose = state.poses[i]
    dx, dy = pose[1, 0] - pose[0, 0], pose[1, 1] - pose[0, 1]
    distance: float = (dx * dx + dy * dy) ** 0.5
    at = state.decisions[i] & (state.sights.shape[1] - 1)
    scale = 1.0 / max(distance, 1e-12)
    state.sights[i, at, 0] = dx * scale
    state.sights[i, at, 1] = dy * scale
    state.sights[i, at, 2] = distance
    return distance


@compiled
def start_games(state: BatchState, games: Any, starts: Any) -> None:
    """Begin games.

    Args:
        state: State of all games.
        games: Indices of those that begin. Shape (m,).
        starts: x, y [m], cosine and sine of the heading of pursuer and
            evader. Shape (m, 2, 4).
    """
    for n in range(len(games)):
        i = games[n]
        for p in range(2):
            copy_values(starts[n, p], state.poses[i, p])
            state.sides[i, p] = 0
            state.walking[i, p] = False
        state.decisions[i] = 0
        state.closest[i] = record_sight(state, i)


@compiled
def decide_by_law(
    state: BatchState, player: int, law: BatchLaw, rules: BatchRules, out: Any
) -> None:
    """Decide for a player of all games by the paper's law.

    Args:
        state: State of all games; sides are updated.
        player: 0 for the pursuer, 1 for the evader.
        law: The law.
        rules: Rules of the game.
        out: Heading [rad] and speed factor of each game. Shape (n, 2).
    """
    ratio = min(law.ratio, max(1.0, 1.0 / rules.share))
    for i in range(len(out)):
        out[i, 0], out[i, 1] = 0.0, 1.0
        if law.code == STANDS:
            out[i, 1] = 0.0
            continue
        pose = state.poses[i]
        dx = pose[1 - player, 0] - pose[player, 0]
        dy = pose[1 - player, 1] - pose[player, 1]
        c, s = pose[player, 2], pose[player, 3]
        bearing = atan2(c * dy - s * dx, c * dx + s * dy)
        if law.code == PURSUES:
            out[i, 0] = min(max(ratio * bearing, -pi), pi)
            continue
        side = state.sides[i, player]
        distance = (dx * dx + dy * dy) ** 0.5
        if not is_evading(side != 0, distance, law.safety_radius, law.release):
            state.sides[i, player] = 0
            out[i, 1] = 0.0
            continue
        side = update_side(side, bearing, law.hysteresis)
        state.sides[i, player] = side
        out[i, 0] = evasion_heading(bearing, side, law.angle)


@inlined
def walk(
    pose: Any, heading: float, speed: float, saturated: bool, r: BatchRules
) -> None:
    """Move one player to its next decision; a negative speed is backward."""
    if saturated:
        turn, most = heading, min(r.share, r.turn)
    else:
        turn, most = r.share * heading, r.turn
    turn = min(max(turn, -most), most) / r.parts
    way = r.stride * speed
    pose[0], pose[1], pose[2], pose[3] = walk_arc(
        pose[0], pose[1], pose[2], pose[3], way, turn
    )


@compiled
def advance_games(
    state: BatchState,
    intents: Any,
    signs: Any,
    saturated: Any,
    rooms: RoomBatch,
    rules: BatchRules,
    outcomes: Any,
) -> None:
    """Move the players of all games to the next decision, and judge.

    Args:
        state: State of all games.
        intents: Heading [rad] and speed factor of pursuer and evader. Shape
            (n, 2, 2).
        signs: 1 for players that walk forward, -1 for backward. Shape (2,).
        saturated: Whether each turns by (6). Shape (2,).
        rooms: Obstacles.
        rules: Rules of the game.
        outcomes: Output: outcome code of each game. Shape (n,).
    """
    for i in range(len(outcomes)):
        for p in range(2):
            speed = intents[i, p, 1]
            state.walking[i, p] = speed > 0.0
            if speed > 0.0:
                walk(
                    state.poses[i, p],
                    intents[i, p, 0],
                    signs[p] * speed,
                    saturated[p],
                    rules,
                )
        state.decisions[i] += 1
        distance = record_sight(state, i)
        outcomes[i] = RUNNING
        evader = state.poses[i, 1]
        radius = rules.body_radius
        if (
            room_clearance(rooms, state.rooms[i], evader[0], evader[1], radius)
            < radius
        ):
            outcomes[i] = TOUCHED
            state.closest[i] = 0.0
            continue
        state.closest[i] = min(state.closest[i], distance)
        if distance <= rules.capture:
            outcomes[i] = CAPTURED


@inlined
def small_angle(sine: float, cosine: float) -> float:
    """Return the angle of a unit vector, quickly where it is small.

    Up to 0.12 rad the power series of the arcsine is accurate to 1e-11.
    """
    if cosine < 0.0 or abs(sine) > 0.12:
        return atan2(sine, cosine)
    z = sine * sine
    series = 1.0 / 6.0 + z * (3.0 / 40.0 + z * (5.0 / 112.0 + z * 35 / 1152))
    return sine + sine * z * series


@inlined
def sight_rates(
    state: BatchState, i: int, rules: BatchRules
) -> tuple[float, float]:
    """Return turning rate [rad/s] of the line of sight, and closing speed."""
    decision, history = state.decisions[i], state.sights.shape[1]
    lag = min(decision, rules.lag)
    if lag < rules.least_lag:
        return 0.0, 0.0
    now = state.sights[i, decision & (history - 1)]
    was = state.sights[i, (decision - lag) & (history - 1)]
    turned = small_angle(
        was[0] * now[1] - was[1] * now[0], was[0] * now[0] + was[1] * now[1]
    )
    passed = lag * rules.period
    return turned / passed, (was[2] - now[2]) / passed


@inlined
def clearances_around(
    pose: Any, rooms: RoomBatch, room: int, rules: BatchRules, out: Any
) -> None:
    """Fill in the term "clearances" of a player at a pose."""
    unit = rules.speed / rules.gain
    for k in range(len(RING)):
        u, v = unit * RING[k, 0], unit * RING[k, 1]
        x = pose[0] + pose[2] * u - pose[3] * v
        y = pose[1] + pose[3] * u + pose[2] * v
        clear = room_clearance(rooms, room, x, y, CLEAREST * unit) / unit
        out[k] = max(clear, -CLEAREST)


@compiled
def observe_games(
    state: BatchState,
    player: int,
    terms: Any,
    rooms: RoomBatch,
    rules: BatchRules,
    out: Any,
) -> None:
    """Compute the observations of a player in all games.

    Args:
        state: State of all games.
        player: 0 for the pursuer, which knows no obstacles, 1 for the
            evader.
        terms: Code of each term, in order. Shape (terms,).
        rooms: Obstacles.
        rules: Rules of the game.
        out: Observations. Shape (n, width).
    """
    unit = rules.speed / rules.gain
    toward = 1.0 if player == 0 else -1.0
    for i in range(len(out)):
        pose = state.poses[i]
        own, opponent = pose[player], pose[1 - player]
        last = state.decisions[i] & (state.sights.shape[1] - 1)
        sight = state.sights[i, last]
        distance = sight[2]
        dx, dy = toward * sight[0], toward * sight[1]  # a unit vector
        rate, closing = sight_rates(state, i, rules)
        at = 0
        for code in terms:
            if code == 0:
                out[i, at] = min(distance / unit, FARTHEST)
            elif code == 1:
                out[i, at] = own[2] * dx + own[3] * dy
                out[i, at + 1] = own[2] * dy - own[3] * dx
            elif code == 2:
                value = rate / rules.gain
                out[i, at] = min(max(value, -FASTEST), FASTEST)
            elif code == 3:
                value = closing / rules.speed
                out[i, at] = min(max(value, -FASTEST), FASTEST)
            elif code == 4:
                out[i, at] = 1.0 if state.walking[i, player] else 0.0
            elif code == 5:
                if player == 0:
                    out[i, at : at + len(RING)] = CLEAREST
                else:
                    clearances_around(
                        own, rooms, state.rooms[i], rules, out[i, at:]
                    )
                at += len(RING) - 1
            elif code == 6:
                out[i, at] = -opponent[2] * dx - opponent[3] * dy
                out[i, at + 1] = opponent[3] * dx - opponent[2] * dy
            elif code == 7:
                out[i, at] = min(state.closest[i] / unit, FARTHEST)
            else:
                out[i, at] = 1.0 - state.decisions[i] / rules.limit
            at += 2 if code == 1 or code == 6 else 1
