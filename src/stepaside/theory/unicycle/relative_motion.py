r"""Relative motion of two unicycles, smooth piece by smooth piece.

.. math::
    \dot r = v_e \cos\psi - v_p \cos a, \qquad
    \Omega = (v_p \sin a - v_e \sin\psi) / r, \qquad
    \dot a = \Omega - \omega_p, \qquad \dot\psi = \Omega - \omega_e

The laws are discontinuous where a wrapped error passes :math:`\pm\pi`, where
the evader changes side, and, saturated, where its error changes sign. Between
these edges

.. math:: \dot\psi = f \Omega - c_1 \psi - c_0,
    \qquad \psi \in [\text{low}, \text{high}].

Numba can compile the functions; those of a state also take arrays of states.
"""

from math import inf, pi
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import inlined
from .. import laws
from .unicycle_game import Game

inlined(laws.wrap_once)  # called by evasion_heading
evasion_heading = inlined(laws.evasion_heading)
side_behind = inlined(laws.side_behind)

# Branches of the evader's turning law.
PROPORTIONAL = 2  # eq. (4)
LEFT, RIGHT = 1, -1  # eq. (6), full rate
SLIDING = 0  # eq. (6), zero error by Filippov's rule
_SIXTH = 1.0 / 6.0
SLACK = 1e-12  # margin below which an edge has been crossed
NEAR = 0.02  # tolerance of being on a circle: 2 % and 0.02 rad


class Rules(NamedTuple):
    """Parameters of a game as plain numbers; see :class:`.Game`.

    The game ends at the capture distance, in [m].
    """

    pursuer_speed: float
    evader_speed: float
    pursuer_gain: float
    evader_gain: float
    angle: float
    hysteresis: float
    keeps_side: bool
    saturated: bool
    capture_distance: float


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


class RelativeState(NamedTuple):
    """Relative coordinates; see :class:`.RelativeStart`."""

    r: Any  # [m]
    a: Any  # [rad]
    psi: Any  # [rad]


class Rates(NamedTuple):
    """Rates of a state, and of the direction of the line of sight."""

    r: Any
    a: Any
    psi: Any
    sight: Any


def rules_of(game: Game, capture_distance: float) -> Rules:
    """Return the parameters of a game and its capture distance as numbers."""
    return Rules(
        float(game.pursuer.speed),
        float(game.evader.speed),
        float(game.pursuer.gain),
        float(game.evader.gain),
        float(game.angle),
        float(game.hysteresis),
        game.keeps_side,
        game.saturated,
        float(capture_distance),
    )


@inlined
def rates_of(state: RelativeState, piece: SmoothPiece, rules: Rules) -> Rates:
    """Return the rates of a state on a smooth piece, extended beyond it."""
    vp, ve = rules.pursuer_speed, rules.evader_speed
    along = ve * np.cos(state.psi) - vp * np.cos(state.a)
    across = vp * np.sin(state.a) - ve * np.sin(state.psi)
    sight = across / state.r
    return Rates(
        along,
        sight - rules.pursuer_gain * state.a,
        piece.free * sight - piece.slope * state.psi - piece.constant,
        sight,
    )


@inlined
def moved(state: RelativeState, rates: Rates, time: float) -> RelativeState:
    """Return the state after a time in [s] at constant rates."""
    return RelativeState(
        state.r + time * rates.r,
        state.a + time * rates.a,
        state.psi + time * rates.psi,
    )


@inlined
def rk4(
    state: RelativeState,
    first: Rates,
    step: float,
    piece: SmoothPiece,
    rules: Rules,
) -> RelativeState:
    """Advance by one Runge-Kutta step of fourth order, from its first rates.

    The law of the piece is extended beyond its edges.
    """
    half = 0.5 * step
    second = rates_of(moved(state, first, half), piece, rules)
    third = rates_of(moved(state, second, half), piece, rules)
    fourth = rates_of(moved(state, third, step), piece, rules)
    mean = Rates(
        first.r + 2.0 * (second.r + third.r) + fourth.r,
        first.a + 2.0 * (second.a + third.a) + fourth.a,
        first.psi + 2.0 * (second.psi + third.psi) + fourth.psi,
        0.0,
    )
    return moved(state, mean, step * _SIXTH)


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
def sight_rate(state: RelativeState, rules: Rules) -> float:
    """Return the turning rate of the line of sight, in [rad/s]."""
    piece = SmoothPiece(0.0, 0.0, 0.0, 0.0, 0.0)
    return float(rates_of(state, piece, rules).sight)


@inlined
def initial_mode(
    state: RelativeState, side: int, rules: Rules
) -> tuple[RelativeState, Mode]:
    """Return state and mode at the start of a game.

    Side 0 stands for the one behind the evader. The bearing that is returned
    may be a whole turn away from the given one, which is in [-pi, pi].
    """
    if side == 0:
        side = side_behind(state.psi)
    error = state.psi + side * rules.angle
    if rules.keeps_side:
        error = evasion_heading(state.psi, side, rules.angle)
    branch = branch_at(error, sight_rate(state, rules), rules)
    psi = error - side * rules.angle
    return RelativeState(state.r, state.a, psi), Mode(side, branch)


@inlined
def edge_margin(
    state: RelativeState, rates: Rates, piece: SmoothPiece, rules: Rules
) -> Any:
    """Return the margin of a state to the next edge; negative beyond it."""
    margin = np.minimum(state.psi - piece.low, piece.high - state.psi)
    if piece.free == 0.0:  # the line of sight may outrun a sliding evader
        margin = rules.evader_gain - abs(rates.sight)
    return np.minimum(margin, pi - abs(state.a))


@inlined
def cross(
    state: RelativeState, mode: Mode, rules: Rules
) -> tuple[RelativeState, Mode]:
    """Return state and mode on the other side of the nearest edge."""
    r, a, psi = state
    side, branch = mode.side, mode.branch
    piece = piece_of(mode, rules)
    low, high = psi - piece.low, piece.high - psi
    sight = sight_rate(state, rules)
    margin = min(low, high)
    if branch == SLIDING:
        margin = rules.evader_gain - abs(sight)
    if pi - abs(a) < margin:  # the pursuer's error wraps
        a += -2.0 * pi if a > 0.0 else 2.0 * pi
        return RelativeState(r, a, psi), mode
    zero = -side * rules.angle
    if branch == SLIDING:
        towards = LEFT if sight > 0.0 else RIGHT
        return RelativeState(r, a, zero), Mode(side, towards)
    if branch == (LEFT if low < high else RIGHT):  # its error is zero
        slides = abs(sight) <= rules.evader_gain
        after = SLIDING if slides else -branch
        return RelativeState(r, a, zero), Mode(side, after)
    turned = psi - (2.0 * pi if high < low else -2.0 * pi)
    if rules.keeps_side:
        after = branch if branch == PROPORTIONAL else -branch
        return RelativeState(r, a, turned), Mode(side, after)
    if (high < low) == (side < 0):
        psi = turned  # the pursuer passes behind the evader's back
    after = branch_at(psi - side * rules.angle, sight, rules)
    return RelativeState(r, a, psi), Mode(-side, after)


@inlined
def deviation(state: RelativeState, side: Any, circle: RelativeState) -> Any:
    """Return the largest deviation of a state from a circle, given at side +1.

    That of r is relative to the circle's, those of a and psi in [rad].
    """
    angles = np.maximum(
        abs(side * state.a - circle.a), abs(side * state.psi - circle.psi)
    )
    return np.maximum(angles, abs(state.r / circle.r - 1.0))
