"""Many duels of unicycles in compiled loops.

A player follows the paper's law, stands, or is given its intents from
outside, as in learning.
"""

from math import atan2, pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arena.obstacles import (
    PackedObstacles,
    clearance_at,
    stop_at,
    touches,
)
from ..arena.shortest_path import find_course
from ..core.compilation import compiled_loop, copy_values, inlined
from ..core.poses import Array
from ..strategies.knowledge import MAX_HEADING
from ..strategies.learned import (
    CLEAREST,
    FARTHEST,
    FASTEST,
    FULL_STATE_TERMS,
    RING_POINTS,
    SENSED_TERMS,
)
from ..strategies.search.step_motion import (
    evasion_heading,
    update_side,
    walk_arc,
)
from ..theory import laws

is_evading = inlined(laws.is_evading)

TERM_CODES = {
    name: code for code, name in enumerate((*SENSED_TERMS, *FULL_STATE_TERMS))
}
"""Terms that :func:`observe_games` computes."""


class BatchState(NamedTuple):
    """State of n games, of pursuer and evader; changed in place."""

    # x, y [m], cosine and sine of the heading. Shape (n, 2, 4).
    poses: Array
    # The last lines of sight, in a ring by decision whose length is a power
    # of two: unit vector to the evader, and distance [m]. (n, history, 3).
    sights: Array
    decisions: NDArray[np.int64]  # so far. Shape (n,).
    # Of evasion, or of a detour; 0 without. Shape (n, 2).
    sides: NDArray[np.int64]
    walking: NDArray[np.bool_]  # by the last intent. Shape (n, 2).
    closest: Array  # so far [m]; 0 after contact with an obstacle. (n,).
    rooms: NDArray[np.int64]  # index of the room. Shape (n,).
    ended: NDArray[np.bool_]  # by capture or contact. Shape (n,).


class BatchRules(NamedTuple):
    """Rules of a game without bodies, as numbers."""

    stride: float  # between two decisions [m]
    share: float  # turn of a step per desired heading, kappa
    parts: float  # decisions per step
    period: float  # between two decisions [s] of path time
    speed: float  # of the template [m/s]
    gain: float  # of the steering [1/s]
    capture: float  # distance [m]
    radii: tuple[float, float]  # of the bodies of pursuer and evader [m]
    limit: int  # decisions until a game ends
    lag: int  # decisions over which rates are differences
    least_lag: int  # over which they are known


class BatchLaw(NamedTuple):
    """Law of a player, as numbers."""

    ratio: float = 0.0  # gain of a pursuer over that of its gait; 0 evades
    radius: float = 0.0  # that it keeps from obstacles [m]
    ahead: float = 0.0  # way on which it foresees them [m]
    angle: float = 0.0  # of evasion [rad]
    safety_radius: float = 0.0  # where evasion begins [m]
    release: float = 0.0  # where it ends [m]
    hysteresis: float = 0.0  # past which the side changes [rad]


class RoomBatch(NamedTuple):
    """Obstacles of many rooms."""

    packed: PackedObstacles
    firsts: NDArray[np.int64]  # of each room, and their number. (rooms + 1,).
    corners: Array  # of paths around obstacles [m]. (n, 2).
    first_corners: NDArray[np.int64]  # likewise. (rooms + 1,).


@inlined
def has_obstacles(rooms: RoomBatch, room: int) -> bool:
    """Return whether one of the rooms has obstacles."""
    return bool(rooms.firsts[room] < rooms.firsts[room + 1])


@inlined
def obstacles_of(rooms: RoomBatch, room: int) -> PackedObstacles:
    """Return the obstacles of one of the rooms."""
    first, end = rooms.firsts[room], rooms.firsts[room + 1]
    packed = rooms.packed
    return PackedObstacles(
        packed.circles[first:end], packed.firsts[first : end + 1], packed.edges
    )


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


@compiled_loop
def start_games(state: BatchState, games: Any, starts: Any) -> None:
    """Begin the games with some indices, at poses of shape (m, 2, 4)."""
    for n in range(len(games)):
        i = games[n]
        for p in range(2):
            copy_values(starts[n, p], state.poses[i, p])
            state.sides[i, p] = 0
            state.walking[i, p] = False
        state.decisions[i], state.ended[i] = 0, False
        state.closest[i] = record_sight(state, i)


@compiled_loop
def decide_by_law(
    state: BatchState,
    player: int,
    law: BatchLaw,
    rooms: RoomBatch,
    rules: BatchRules,
    out: Any,
) -> None:
    """Decide for player 0 or 1 of all games by the paper's law.

    Fills in the heading [rad] and speed factor of each game, shape (n, 2).
    """
    ratio = min(law.ratio, max(1.0, 1.0 / rules.share))
    for i in range(len(out)):
        out[i, 0], out[i, 1] = 0.0, 1.0
        pose = state.poses[i]
        dx = pose[1 - player, 0] - pose[player, 0]
        dy = pose[1 - player, 1] - pose[player, 1]
        c, s = pose[player, 2], pose[player, 3]
        bearing = atan2(c * dy - s * dx, c * dx + s * dy)
        side, bends = state.sides[i, player], False
        if law.ratio:
            room = state.rooms[i]
            if has_obstacles(rooms, room):
                first, end = rooms.first_corners[room : room + 2]
                bearing, state.sides[i, player], bends = find_course(
                    obstacles_of(rooms, room),
                    rooms.corners[first:end],
                    (pose[player, 0], pose[player, 1], c, s),
                    (pose[1 - player, 0], pose[1 - player, 1]),
                    law.radius,
                    side,
                    law.ahead,
                )
            if bends:
                heading = bearing / rules.share
                out[i, 0] = min(max(heading, -MAX_HEADING), MAX_HEADING)
            else:
                out[i, 0] = min(max(ratio * bearing, -pi), pi)
            continue
        distance = (dx * dx + dy * dy) ** 0.5
        if not is_evading(side != 0, distance, law.safety_radius, law.release):
            state.sides[i, player] = 0
            out[i, 1] = 0.0
            continue
        side = update_side(side, bearing, law.hysteresis)
        state.sides[i, player] = side
        out[i, 0] = evasion_heading(bearing, side, law.angle)


@compiled_loop
def advance_games(
    state: BatchState,
    intents: Any,
    saturated: Any,
    rooms: RoomBatch,
    rules: BatchRules,
) -> None:
    """Move the players of all games to the next decision, and judge.

    ``intents`` are heading [rad] and speed factor of pursuer and evader,
    shape (n, 2, 2); ``saturated`` tells who turns by (6), shape (2,).
    """
    for i in range(len(intents)):
        room = state.rooms[i]
        for p in range(2):
            heading, speed = intents[i, p, 0], intents[i, p, 1]
            state.walking[i, p] = speed > 0.0
            if speed <= 0.0:
                continue
            if saturated[p]:
                turn = min(max(heading, -rules.share), rules.share)
            else:
                turn = rules.share * heading
            way = rules.stride * (speed if p == 0 else -speed)
            pose = state.poses[i, p]
            x, y, pose[2], pose[3] = walk_arc(
                pose[0], pose[1], pose[2], pose[3], way, turn / rules.parts
            )
            if p == 0 and has_obstacles(rooms, room):
                known = obstacles_of(rooms, room)
                x, y = stop_at(known, pose, (x, y), rules.radii[0])
            pose[0], pose[1] = x, y
        state.decisions[i] += 1
        distance = record_sight(state, i)
        x, y = state.poses[i, 1, 0], state.poses[i, 1, 1]
        if has_obstacles(rooms, room) and touches(
            obstacles_of(rooms, room), x, y, rules.radii[1]
        ):
            state.ended[i], state.closest[i] = True, 0.0
            continue
        state.closest[i] = min(state.closest[i], distance)
        state.ended[i] = distance <= rules.capture


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
    unit, packed = rules.speed / rules.gain, obstacles_of(rooms, room)
    for k in range(len(RING_POINTS)):
        u, v = unit * RING_POINTS[k, 0], unit * RING_POINTS[k, 1]
        x = pose[0] + pose[2] * u - pose[3] * v
        y = pose[1] + pose[3] * u + pose[2] * v
        clear = clearance_at(packed, x, y, CLEAREST * unit) / unit
        out[k] = max(clear, -CLEAREST)


@compiled_loop
def observe_games(
    state: BatchState,
    player: int,
    terms: Any,
    rooms: RoomBatch,
    rules: BatchRules,
    out: Any,
) -> None:
    """Compute the observations of a player in all games, shape (n, width).

    Player 0 is the pursuer; ``terms`` are codes.
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
                clearances_around(
                    own, rooms, state.rooms[i], rules, out[i, at:]
                )
                at += len(RING_POINTS) - 1
            elif code == 6:
                out[i, at] = -opponent[2] * dx - opponent[3] * dy
                out[i, at + 1] = opponent[3] * dx - opponent[2] * dy
            elif code == 7:
                out[i, at] = min(state.closest[i] / unit, FARTHEST)
            else:
                out[i, at] = 1.0 - state.decisions[i] / rules.limit
            at += 2 if code == 1 or code == 6 else 1
