r"""Relative motion of two unicycles on a smooth piece, and one step of it.

.. math::
    \dot r = v_e \cos\psi - v_p \cos a, \qquad
    \Omega = (v_p \sin a - v_e \sin\psi) / r, \qquad
    \dot a = \Omega - \omega_p, \qquad \dot\psi = \Omega - \omega_e

The functions take numbers, or arrays of one shape, and may be compiled.
"""

from collections.abc import Callable
from math import cos, sin
from typing import Any, NamedTuple

import numpy as np

from .. import laws
from .compilation import inlined
from .game_parameters import FlatParameters
from .smooth_pieces import SmoothPiece, proportional_rate

pursuit_heading = inlined(laws.pursuit_heading)

SIXTH = 1.0 / 6.0


class RelativeState(NamedTuple):
    """Relative coordinates of one game, or of many.

    Attributes:
        r: Distance, in [m].
        a: Bearing of the evader seen by the pursuer, its error, in [rad].
        psi: Bearing of the pursuer seen by the evader, in [rad].
    """

    r: Any
    a: Any
    psi: Any


class SightGeometry(NamedTuple):
    """What is worked out of a state: sines, and how the line of sight moves.

    Attributes:
        sin_a: Sine of the bearing of the evader.
        cos_a: Its cosine.
        sin_psi: Sine of the bearing of the pursuer.
        cos_psi: Its cosine.
        opening: Rate of the distance, in [m/s]; negative while it shrinks.
        sight: Rate of the line of sight, in [rad/s].
    """

    sin_a: Any
    cos_a: Any
    sin_psi: Any
    cos_psi: Any
    opening: Any
    sight: Any


Look = Callable[[RelativeState, FlatParameters], SightGeometry]
"""Gives the view of a state."""
LookNear = Callable[
    [RelativeState, RelativeState, SightGeometry, FlatParameters],
    SightGeometry,
]
"""Gives the view of a state near another one whose view is known."""


@inlined
def view_of(
    r: Any,
    sin_a: Any,
    cos_a: Any,
    sin_psi: Any,
    cos_psi: Any,
    rules: FlatParameters,
) -> SightGeometry:
    """View from a distance and the sines and cosines of both bearings."""
    vp, ve = rules.pursuer_speed, rules.evader_speed
    opening = ve * cos_psi - vp * cos_a
    sight = (vp * sin_a - ve * sin_psi) / r
    return SightGeometry(sin_a, cos_a, sin_psi, cos_psi, opening, sight)


@inlined
def look(state: RelativeState, rules: FlatParameters) -> SightGeometry:
    """View of one state."""
    r, a, psi = state
    return view_of(r, sin(a), cos(a), sin(psi), cos(psi), rules)


def look_many(state: RelativeState, rules: FlatParameters) -> SightGeometry:
    """View of states in arrays."""
    r, a, psi = state
    return view_of(r, np.sin(a), np.cos(a), np.sin(psi), np.cos(psi), rules)


@inlined
def look_anew(
    state: RelativeState,
    near: RelativeState,
    view: SightGeometry,
    rules: FlatParameters,
) -> SightGeometry:
    """View of one state, whatever is known nearby."""
    return look(state, rules)


@inlined
def derivative(
    state: RelativeState,
    view: SightGeometry,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> RelativeState:
    """Rates of the three coordinates on a piece."""
    error = pursuit_heading(state.a)
    return RelativeState(
        view.opening,
        view.sight - proportional_rate(error, rules.pursuer_gain),
        piece.free * view.sight - piece.slope * state.psi - piece.constant,
    )


@inlined
def moved(
    state: RelativeState, slope: RelativeState, time: Any
) -> RelativeState:
    """State after a time at constant rates."""
    return RelativeState(
        state.r + time * slope.r,
        state.a + time * slope.a,
        state.psi + time * slope.psi,
    )


@inlined
def rk4(
    look_near: LookNear,
    state: RelativeState,
    view: SightGeometry,
    step: Any,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> RelativeState:
    """Advance by one step of Runge and Kutta's rule of fourth order.

    Args:
        look_near: How the views within the step are found.
        state: State at the start of the step.
        view: Its view.
        step: Length of the step, in [s].
        piece: Smooth piece; its law also holds beyond its edges.
        rules: Rules of the game.
    """
    half = 0.5 * step
    first = derivative(state, view, piece, rules)
    there = moved(state, first, half)
    seen = look_near(there, state, view, rules)
    second = derivative(there, seen, piece, rules)
    there = moved(state, second, half)
    seen = look_near(there, state, view, rules)
    third = derivative(there, seen, piece, rules)
    there = moved(state, third, step)
    seen = look_near(there, state, view, rules)
    fourth = derivative(there, seen, piece, rules)
    mean = RelativeState(
        first.r + 2.0 * (second.r + third.r) + fourth.r,
        first.a + 2.0 * (second.a + third.a) + fourth.a,
        first.psi + 2.0 * (second.psi + third.psi) + fourth.psi,
    )
    return moved(state, mean, step * SIXTH)
