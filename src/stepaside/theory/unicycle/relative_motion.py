r"""Relative motion of two unicycles on a smooth piece.

.. math::
    \dot r = v_e \cos\psi - v_p \cos a, \qquad
    \Omega = (v_p \sin a - v_e \sin\psi) / r, \qquad
    \dot a = \Omega - \omega_p, \qquad \dot\psi = \Omega - \omega_e

The functions take numbers, or arrays of one shape, and can be compiled.
"""

from collections.abc import Callable
from math import cos, sin
from typing import Any, NamedTuple

import numpy as np

from ...core.compilation import inlined
from .. import laws
from .game_parameters import FlatParameters
from .piecewise_dynamics import SmoothPiece, proportional_rate

pursuit_heading = inlined(laws.pursuit_heading)

SIXTH = 1.0 / 6.0


class RelativeState(NamedTuple):
    """Relative coordinates of one game, or of many.

    Attributes:
        r: Distance, in [m].
        a: Bearing of the evader in the pursuer's frame, its error, in [rad].
        psi: Bearing of the pursuer in the evader's frame, in [rad].
    """

    r: Any
    a: Any
    psi: Any


class SightGeometry(NamedTuple):
    """Sines of the bearings and motion of the line of sight.

    Attributes:
        sin_a: Sine of the bearing of the evader.
        cos_a: Cosine of the bearing of the evader.
        sin_psi: Sine of the bearing of the pursuer.
        cos_psi: Cosine of the bearing of the pursuer.
        opening: Rate of the distance, in [m/s].
        sight: Turning rate of the line of sight, in [rad/s].
    """

    sin_a: Any
    cos_a: Any
    sin_psi: Any
    cos_psi: Any
    opening: Any
    sight: Any


GeometryFunction = Callable[[RelativeState, FlatParameters], SightGeometry]
"""Returns the geometry of a state."""
NearbyGeometry = Callable[
    [RelativeState, RelativeState, SightGeometry, FlatParameters],
    SightGeometry,
]
"""Returns the geometry of a state near another one with known geometry."""


@inlined
def geometry_from_sines(
    r: Any,
    sin_a: Any,
    cos_a: Any,
    sin_psi: Any,
    cos_psi: Any,
    rules: FlatParameters,
) -> SightGeometry:
    """Return the geometry from distance, sines and cosines of bearings."""
    vp, ve = rules.pursuer_speed, rules.evader_speed
    opening = ve * cos_psi - vp * cos_a
    sight = (vp * sin_a - ve * sin_psi) / r
    return SightGeometry(sin_a, cos_a, sin_psi, cos_psi, opening, sight)


@inlined
def geometry_of(state: RelativeState, rules: FlatParameters) -> SightGeometry:
    """Return the geometry of one state."""
    r, a, psi = state
    return geometry_from_sines(r, sin(a), cos(a), sin(psi), cos(psi), rules)


def geometry_of_arrays(
    state: RelativeState, rules: FlatParameters
) -> SightGeometry:
    """Return the geometry of states in arrays."""
    r, a, psi = state
    return geometry_from_sines(
        r, np.sin(a), np.cos(a), np.sin(psi), np.cos(psi), rules
    )


@inlined
def recomputed_geometry(
    state: RelativeState,
    near: RelativeState,
    geometry: SightGeometry,
    rules: FlatParameters,
) -> SightGeometry:
    """Return the geometry of one state, ignoring the nearby one."""
    return geometry_of(state, rules)


@inlined
def derivative(
    state: RelativeState,
    geometry: SightGeometry,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> RelativeState:
    """Return the rates of the three coordinates on a smooth piece."""
    error = pursuit_heading(state.a)
    return RelativeState(
        geometry.opening,
        geometry.sight - proportional_rate(error, rules.pursuer_gain),
        piece.free * geometry.sight - piece.slope * state.psi - piece.constant,
    )


@inlined
def moved(
    state: RelativeState, slope: RelativeState, time: Any
) -> RelativeState:
    """Return the state after a time in [s] at constant rates."""
    return RelativeState(
        state.r + time * slope.r,
        state.a + time * slope.a,
        state.psi + time * slope.psi,
    )


@inlined
def rk4(
    nearby_geometry: NearbyGeometry,
    state: RelativeState,
    geometry: SightGeometry,
    step: Any,
    piece: SmoothPiece,
    rules: FlatParameters,
) -> RelativeState:
    """Advance by one Runge-Kutta step of fourth order.

    Args:
        nearby_geometry: Computes the geometry of the stages.
        state: State at the begin of the step.
        geometry: Geometry of that state.
        step: Step size, in [s].
        piece: Smooth piece; its law is extended beyond its edges.
        rules: Rules of the game.
    """
    half = 0.5 * step
    first = derivative(state, geometry, piece, rules)
    stage = moved(state, first, half)
    stage_geometry = nearby_geometry(stage, state, geometry, rules)
    second = derivative(stage, stage_geometry, piece, rules)
    stage = moved(state, second, half)
    stage_geometry = nearby_geometry(stage, state, geometry, rules)
    third = derivative(stage, stage_geometry, piece, rules)
    stage = moved(state, third, step)
    stage_geometry = nearby_geometry(stage, state, geometry, rules)
    fourth = derivative(stage, stage_geometry, piece, rules)
    mean = RelativeState(
        first.r + 2.0 * (second.r + third.r) + fourth.r,
        first.a + 2.0 * (second.a + third.a) + fourth.a,
        first.psi + 2.0 * (second.psi + third.psi) + fourth.psi,
    )
    return moved(state, mean, step * SIXTH)
