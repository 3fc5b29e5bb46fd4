r"""Relative motion of two unicycles, smooth piece by smooth piece, compiled.

.. math::
    \dot r = v_e \cos\psi - v_p \cos a, \qquad
    \Omega = (v_p \sin a - v_e \sin\psi) / r, \qquad
    \dot a = \Omega - \omega_p, \qquad \dot\psi = \Omega - \omega_e

The laws are discontinuous where a wrapped error passes :math:`\pm\pi`, where
the evader changes side, and, saturated, where its error changes sign. Between
these edges

.. math:: \dot\psi = f \Omega - c_1 \psi - c_0,
    \qquad \psi \in [\text{low}, \text{high}].

A step of the integration ends at the edge of its piece or at the capture; it
is short where the distance is.
"""

from math import inf, pi
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import (
    compiled,
    compiled_parallel,
    copy_values,
    inlined,
    parallel_range,
    shared,
)
from .. import laws
from .unicycle_game import Unicycles

prange = parallel_range()
inlined(laws.wrap_once)  # called by evasion_heading
evasion_heading = inlined(laws.evasion_heading)
side_behind = inlined(laws.side_behind)

# Branches of the evader's turning law.
PROPORTIONAL = 2  # eq. (4)
LEFT, RIGHT = 1, -1  # eq. (6), full rate
SLIDING = 0  # eq. (6), zero error by Filippov's rule
SLACK = 1e-12  # margin below which an edge has been crossed
NEAR = 0.02  # tolerance of being on a circle: 2 % and 0.02 rad
TURN_PER_STEP = 0.04  # longest step, in distances per sum of the speeds
EDGE, CLOSEST, CAPTURE = 0, 1, 2  # events within a step
EVERY = 128  # steps from one row of a record to the next, without an edge
# Columns of a game that is played: time, state, mode and number of edges
# passed; closest approach and its time, the time of capture, -1 for none, the
# last time off all circles, and the number of the circle that it is on, -1
# for none.
TIME, SIDE, BRANCH, PASSED = 0, 7, 8, 9
LEAST, WHEN, CAPTURED, SETTLED, CIRCLE = 10, 11, 12, 13, 14
COLUMNS = 15


class Rules(NamedTuple):
    """Parameters of a game as plain numbers; see :class:`.Unicycles`."""

    pursuer_speed: float
    evader_speed: float
    pursuer_gain: float
    evader_gain: float
    angle: float
    hysteresis: float
    keeps_side: bool
    saturated: bool
    capture_distance: float  # at which the game ends, in [m]


class Mode(NamedTuple):
    """Discrete state that identifies a smooth piece."""

    side: int  # of the line of sight that the evader takes, +1 or -1
    branch: int  # of its turning law


class SmoothPiece(NamedTuple):
    """Coefficients of a smooth piece."""

    low: float  # least bearing, in [rad]
    high: float
    constant: float  # turning rate of the evader at bearing zero, in [rad/s]
    slope: float  # derivative of the turning rate by the bearing, in [1/s]
    free: float  # 0 if the evader turns with the line of sight, else 1


class GameState(NamedTuple):
    """State of a game, or its rates; numbers or arrays.

    Relative coordinates are those of :class:`.RelativeStart`, in [m] and
    [rad]; the others are in the initial frame of the pursuer.
    """

    r: Any
    a: Any
    psi: Any
    sight: Any  # direction of the line of sight, in [rad]
    x: Any  # of the pursuer, in [m]
    y: Any


def rules_of(game: Unicycles, capture_distance: float) -> Rules:
    """Return the parameters of a game and its capture distance as numbers."""
    return Rules(
        *game.numbers,
        float(game.hysteresis),
        game.keeps_side,
        game.saturated,
        float(capture_distance),
    )


@inlined
def sight_rate(state: GameState, rules: Rules) -> Any:
    """Return the turning rate of the line of sight, in [rad/s]."""
    vp, ve = rules.pursuer_speed, rules.evader_speed
    return (vp * np.sin(state.a) - ve * np.sin(state.psi)) / state.r


@inlined
def rates_of(state: GameState, piece: SmoothPiece, rules: Rules) -> GameState:
    """Return the rates of a state on a smooth piece, extended beyond it."""
    vp, ve = rules.pursuer_speed, rules.evader_speed
    sight = sight_rate(state, rules)
    heading = state.sight - state.a
    return GameState(
        ve * np.cos(state.psi) - vp * np.cos(state.a),
        sight - rules.pursuer_gain * state.a,
        piece.free * sight - piece.slope * state.psi - piece.constant,
        sight,
        vp * np.cos(heading),
        vp * np.sin(heading),
    )


@inlined
def moved(state: GameState, rates: GameState, time: Any) -> GameState:
    """Return the state after a time in [s] at constant rates."""
    return GameState(
        state.r + time * rates.r,
        state.a + time * rates.a,
        state.psi + time * rates.psi,
        state.sight + time * rates.sight,
        state.x + time * rates.x,
        state.y + time * rates.y,
    )


@inlined
def rk4(
    state: GameState, time: Any, piece: SmoothPiece, rules: Rules
) -> GameState:
    """Advance by one Runge-Kutta step of fourth order.

    The law of the piece is extended beyond its edges.
    """
    first = rates_of(state, piece, rules)
    second = rates_of(moved(state, first, 0.5 * time), piece, rules)
    third = rates_of(moved(state, second, 0.5 * time), piece, rules)
    fourth = rates_of(moved(state, third, time), piece, rules)
    outer = moved(moved(state, first, time / 6.0), fourth, time / 6.0)
    return moved(moved(outer, second, time / 3.0), third, time / 3.0)


@inlined
def piece_of(mode: Mode, rules: Rules) -> SmoothPiece:
    """Return the coefficients of a smooth piece."""
    gain, width = rules.evader_gain, rules.hysteresis
    zero = -mode.side * rules.angle  # bearing of zero error
    if mode.branch == SLIDING:
        return SmoothPiece(-inf, inf, 0.0, 0.0, 0.0)
    if rules.keeps_side:
        low, high = zero - pi, zero + pi
    elif mode.side < 0:
        low, high = -width, pi + width
    else:
        low, high = -pi - width, width
    if mode.branch == PROPORTIONAL:
        return SmoothPiece(low, high, -gain * zero, gain, 1.0)
    if mode.branch == LEFT:
        return SmoothPiece(zero, high, gain, 0.0, 1.0)
    return SmoothPiece(low, zero, -gain, 0.0, 1.0)


@inlined
def branch_at(error: float, sight: float, rules: Rules) -> int:
    """Return the branch for an error and a rate of the line of sight."""
    if not rules.saturated:
        return PROPORTIONAL
    if error == 0.0:
        if abs(sight) <= rules.evader_gain:
            return SLIDING
        error = sight
    return LEFT if error > 0.0 else RIGHT


@inlined
def edge_margin(state: GameState, piece: SmoothPiece, rules: Rules) -> float:
    """Return the margin of a state to the next edge; negative beyond it."""
    margin = min(state.psi - piece.low, piece.high - state.psi)
    if piece.free == 0.0:  # the line of sight may outrun a sliding evader
        margin = rules.evader_gain - abs(sight_rate(state, rules))
    return float(min(margin, pi - abs(state.a)))


@inlined
def cross(
    state: GameState, mode: Mode, rules: Rules
) -> tuple[GameState, Mode]:
    """Return state and mode on the other side of the nearest edge."""
    r, a, psi, line, x, y = state
    side, branch = mode.side, mode.branch
    piece = piece_of(mode, rules)
    low, high = psi - piece.low, piece.high - psi
    sight = sight_rate(state, rules)
    margin = min(low, high)
    if branch == SLIDING:
        margin = rules.evader_gain - abs(sight)
    zero = -side * rules.angle
    turned = psi - (2.0 * pi if high < low else -2.0 * pi)
    if pi - abs(a) < margin:  # the pursuer's error wraps
        a += -2.0 * pi if a > 0.0 else 2.0 * pi
    elif branch == SLIDING:
        psi, branch = zero, LEFT if sight > 0.0 else RIGHT
    elif branch == (LEFT if low < high else RIGHT):  # its error is zero
        slides = abs(sight) <= rules.evader_gain
        psi, branch = zero, SLIDING if slides else -branch
    elif rules.keeps_side:
        psi = turned
        branch = branch if branch == PROPORTIONAL else -branch
    else:
        if (high < low) == (side < 0):
            psi = turned  # the pursuer passes behind the evader's back
        branch = branch_at(psi - side * rules.angle, sight, rules)
        side = -side
    return GameState(r, a, psi, line, x, y), Mode(side, branch)


@inlined
def is_before(
    time: float,
    event: int,
    state: GameState,
    piece: SmoothPiece,
    rules: Rules,
) -> bool:
    """Return whether an event is yet to come after a time."""
    then = rk4(state, time, piece, rules)
    if event == EDGE:
        return edge_margin(then, piece, rules) > 0.0
    if event == CAPTURE:
        return bool(then.r > rules.capture_distance)
    return bool(rates_of(then, piece, rules).r < 0.0)


@shared
def time_of(
    event: int,
    state: GameState,
    step: float,
    piece: SmoothPiece,
    rules: Rules,
) -> float:
    """Return the time of an event within a step, in [s], by bisection.

    A game that starts on an edge may first enter the piece and then leave it.
    """
    early, late = 0.0, step
    for halvings in range(49):
        if is_before(early, event, state, piece, rules):
            break
        early = step * 0.5 ** (halvings + 1)
    for _ in range(60):
        middle = 0.5 * (early + late)
        if not early < middle < late:
            break
        if is_before(middle, event, state, piece, rules):
            early = middle
        else:
            late = middle
    return late if is_before(early, event, state, piece, rules) else 0.0


@shared
def begin(game: Any, start: Any, side: int, rules: Rules) -> None:
    """Begin a game at r, a, psi; side 0 is the one behind the evader.

    The bearing of its state may be a whole turn away from the given one.
    """
    r, a, psi = start[0], start[1], start[2]
    if side == 0:
        side = side_behind(psi)
    error = psi + side * rules.angle
    if rules.keeps_side:
        error = evasion_heading(psi, side, rules.angle)
    state = GameState(r, a, psi, a, 0.0, 0.0)
    game[BRANCH] = branch_at(error, sight_rate(state, rules), rules)
    game[SIDE], game[TIME], game[PASSED] = side, 0.0, 0.0
    game[1], game[2], game[3], game[4] = r, a, error - side * rules.angle, a
    game[5] = game[6] = 0.0
    game[LEAST], game[WHEN], game[SETTLED], game[CIRCLE] = r, 0.0, 0.0, -1.0
    game[CAPTURED] = 0.0 if r <= rules.capture_distance else -1.0


@compiled
def play_on(
    game: Any,
    circles: Any,
    step: float,
    end: float,
    rules: Rules,
    record: Any,
) -> int:
    """Play a game to a time, or until a record is full; return its length.

    A record has copies of the game after some steps, and after each edge; one
    without rows is never full. Circles are rows of r [m], a, psi [rad] at
    side +1. Shape (m, 3).
    """
    state = GameState(game[1], game[2], game[3], game[4], game[5], game[6])
    mode = Mode(int(game[SIDE]), int(game[BRANCH]))
    speeds = rules.pursuer_speed + rules.evader_speed
    count, since, passed, now = 0, 0, -1.0, game[TIME]
    while now < end and game[CAPTURED] < 0.0:
        if len(record) and (since == EVERY or passed != game[PASSED]):
            if count == len(record):
                break
            copy_values(game, record[count])
            count, since, passed = count + 1, 0, game[PASSED]
        since += 1
        piece = piece_of(mode, rules)
        part = min(step, end - now, TURN_PER_STEP * state.r / speeds)
        then = rk4(state, part, piece, rules)
        leaves = edge_margin(then, piece, rules) < -SLACK
        if leaves:
            part = time_of(EDGE, state, part, piece, rules)
            then = rk4(state, part, piece, rules)
        near, when = then.r, part
        closes = rates_of(state, piece, rules).r < 0.0
        if closes and rates_of(then, piece, rules).r > 0.0:
            when = time_of(CLOSEST, state, part, piece, rules)
            near = rk4(state, when, piece, rules).r
        if near <= rules.capture_distance:
            part = when = time_of(CAPTURE, state, when, piece, rules)
            then = rk4(state, part, piece, rules)
            near, game[CAPTURED] = then.r, now + part
        elif leaves:
            then, mode = cross(then, mode, rules)
            game[PASSED] += 1
        if near < game[LEAST]:
            game[LEAST], game[WHEN] = near, now + when
        now, state, game[CIRCLE] = now + part, then, -1.0
        for c in range(len(circles)):
            off = abs(state.r / circles[c, 0] - 1.0)
            off = max(off, abs(mode.side * state.a - circles[c, 1]))
            if max(off, abs(mode.side * state.psi - circles[c, 2])) <= NEAR:
                game[CIRCLE] = c
        if game[CIRCLE] < 0.0:
            game[SETTLED] = now
        game[TIME], game[SIDE], game[BRANCH] = now, mode.side, mode.branch
        game[1], game[2], game[3] = state.r, state.a, state.psi
        game[4], game[5], game[6] = state.sight, state.x, state.y
    return count


@compiled_parallel
def play_all(
    games: Any,
    starts: Any,
    side: int,
    circles: Any,
    step: float,
    end: float,
    rules: Rules,
    record: Any,
) -> None:
    """Play games from starts to a time, on all cores. Shape (n, COLUMNS)."""
    for i in prange(len(games)):
        begin(games[i], starts[i], side, rules)
        play_on(games[i], circles, step, end, rules, record)
